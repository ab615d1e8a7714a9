//! How firm the body is from tick to tick.

use super::Servo;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::touch::ContactMode;
use crate::control::firmness::Firmness;
use crate::control::pressed::Pressed;
use crate::pile::laid::Beside;
use crate::servo::settings::{Firm, Moment, Settings};

/// A body is moved by so many times as far at most by what it remembers as by what presses it.
const MOST_REMEMBERED: f64 = 1e3;

impl Servo {
    /// How firm the body is in this tick, from what was held in the last one; nothing where it is linear.
    pub(super) fn firm(&mut self, settings: &Settings, dt: f64) -> Option<Firm> {
        let is_consistent = settings.feel.mode == ContactMode::Consistent;
        let is_pressed = self.pressed > 0.0;
        if !(is_consistent && is_pressed) {
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
        let held = energy / moment.settings.young_modulus;
        let by_fingers: f64 = pressed.iter().map(|finger| finger.remembered).sum();
        let on_remembered = by_fingers + beside.remembered;
        let remembered = if energy > 0.0 {
            (0.5 * on_remembered / energy).clamp(0.0, MOST_REMEMBERED)
        } else {
            0.0
        };
        // What a linear body would hold that is pressed in as far and remembers nothing.
        self.pressed = held * (1.0 + remembered) * (1.0 + remembered);
        let Some(firm) = moment.firmness else {
            return beside.held;
        };
        // What is held is the integral of the firmness, where the contact told its end.
        let share = self.firmness.mean(held, remembered) / firm.share;
        if let Some(own) = beside.own {
            return beside.held + own * (share - 1.0);
        }
        let kept = self.firmness.kept(held, remembered);
        for finger in pressed {
            finger.carried *= 1.0 - kept;
            (finger.energy, finger.own_energy) = (finger.energy * share, finger.own_energy * share);
        }
        beside.held * share
    }
}
