//! How firm the body is from tick to tick.

use super::Servo;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::touch::ContactMode;
use crate::control::lending::Held;
use crate::control::pressed::Pressed;
use crate::control::toll::Given;
use crate::pile::laid::Beside;
use crate::servo::settings::{Firm, Moment, Settings};

/// A body is moved by so many times as far at most by what it remembers as by what presses it.
const MOST_REMEMBERED: f64 = 1e3;

impl Servo {
    /// How firm the body is in this tick, from what was held in the last one; nothing where it is linear.
    pub(super) fn firm(&mut self, settings: &Settings, dt: f64) -> Option<Firm> {
        let is_consistent = settings.feel.mode == ContactMode::Consistent;
        let is_pressed = self.pressed > 0.0;
        let told = (is_consistent && is_pressed).then_some(&settings.firmness);
        self.lending.lead(told, dt);
        let firmness = self.lending.firmness();
        if firmness.is_linear() {
            return None;
        }
        Some(Firm {
            modulus: settings.young_modulus,
            share: firmness.at(self.pressed),
            steepness: firmness.steepness(self.pressed),
        })
    }

    /// Keeps what the linear contact holds in the body, and has fingers hold what goes with the firmness; what
    /// can be given back more than in the last tick beside what they hold.
    pub(super) fn hold(
        &mut self,
        moment: &Moment<'_>,
        pressed: &mut [Pressed; MAX_FINGERS],
        beside: Beside,
        raised: f64,
    ) -> Given {
        let (stored, lent) = self.held_beside(moment, pressed, beside);
        let all = raised + stored - std::mem::replace(&mut self.stored, raised + stored);
        Given { all, lent }
    }

    /// What all else than fingers holds, J, and what of that is lent.
    fn held_beside(
        &mut self,
        moment: &Moment<'_>,
        pressed: &mut [Pressed; MAX_FINGERS],
        beside: Beside,
    ) -> (f64, f64) {
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
        let firm = moment.firmness.map_or(1.0, |firm| firm.share);
        let now = Held {
            energy: energy / firm,
            unit: held,
            remembered,
        };
        let lent = self.lending.lent(now);
        // What a linear body would hold that is pressed in as far and remembers nothing.
        self.pressed = held * (1.0 + remembered) * (1.0 + remembered);
        if moment.firmness.is_none() {
            return (beside.held, 0.0);
        }
        // What is held is the integral of the firmness, where the contact told its end.
        let firmness = self.lending.firmness();
        let share = firmness.mean(held, remembered) / firm;
        if let Some(own) = beside.own {
            return (beside.held + own * (share - 1.0), lent);
        }
        let kept = firmness.kept(held, remembered);
        let part = if energy > 0.0 { lent / energy } else { 0.0 };
        for finger in pressed {
            finger.carried *= 1.0 - kept;
            finger.lent = part * finger.energy;
            (finger.energy, finger.own_energy) = (finger.energy * share, finger.own_energy * share);
        }
        (beside.held * share, part * beside.held)
    }
}
