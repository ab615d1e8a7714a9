//! How firm the body is from tick to tick.

use super::Servo;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::touch::ContactMode;
use crate::control::firmness::Firmness;
use crate::control::pressed::Pressed;
use crate::pile::laid::Beside;
use crate::servo::settings::{Firm, Moment, Settings};

impl Servo {
    /// How firm the body is in this tick, from what was held in the last one; nothing where it is linear.
    pub(super) fn firm(&mut self, settings: &Settings, is_felt: bool, dt: f64) -> Option<Firm> {
        let is_consistent = settings.feel.mode == ContactMode::Consistent;
        let is_pressed = self.pressed > 0.0;
        if !(is_felt && is_consistent && is_pressed) {
            self.firmness = Firmness::default();
            return None;
        }
        self.firmness = self.firmness.faded(&settings.firmness, dt);
        if self.firmness.is_linear() {
            return None;
        }
        Some(Firm {
            modulus: settings.young_modulus,
            share: self.firmness.at(self.pressed),
            steepness: self.firmness.steepness(self.pressed),
        })
    }

    /// Keeps what the linear contact holds in the body, and has fingers hold what goes with the firmness; what
    /// all else holds then, J.
    pub(super) fn hold(
        &mut self,
        moment: &Moment<'_>,
        pressed: &mut [Pressed; MAX_FINGERS],
        beside: Beside,
    ) -> f64 {
        let fingers: f64 = pressed.iter().map(|finger| finger.energy).sum();
        let energy = beside.own.unwrap_or(fingers + beside.held);
        self.pressed = energy / moment.settings.young_modulus;
        let Some(firm) = moment.firmness else {
            return beside.held;
        };
        // What is held is the integral of the firmness, where the contact told its end.
        let share = self.firmness.mean(self.pressed) / firm.share;
        if let Some(own) = beside.own {
            return beside.held + own * (share - 1.0);
        }
        for finger in pressed {
            (finger.energy, finger.own_energy) = (finger.energy * share, finger.own_energy * share);
        }
        beside.held * share
    }
}
