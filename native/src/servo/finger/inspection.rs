//! Findings: what is wrong with a finger in a tick, before its contact.

use super::Finger;
use crate::control::state::Findings;
use crate::device::{Fault, Probe, Reading, reason};
use crate::servo::settings::Moment;

/// Two ticks further apart than this were interrupted: the device has gone limp meanwhile, s.
const SUSPENDED_SECONDS: f64 = 0.02;
/// For so long after a gap, what the line had stored may have holes, s.
const HOLES_SECONDS: f64 = 0.05;
/// A device slower than this part of the largest speed is calm.
const CALM_PART: f64 = 0.5;

impl Finger {
    /// Findings of the clock, the device and the settings.
    pub(super) fn inspect(
        &mut self,
        moment: &Moment<'_>,
        reading: &Reading,
        tip_fits: bool,
    ) -> Findings {
        let Moment {
            now, gap, settings, ..
        } = *moment;
        let max_speed = moment.options.max_speed;
        // While there is no force, a gap endangers nobody.
        if gap > SUSPENDED_SECONDS {
            self.interrupted_at = now;
        }
        let is_suspended = self.standing.fault == Some(Fault::Suspended);
        let was_pushing = is_suspended || self.standing.state.may_push();
        let fault = match reading {
            _ if was_pushing && gap > SUSPENDED_SECONDS => Some(Fault::Suspended),
            Reading::At(probe) | Reading::Passive(probe, _) => match fault_of(probe, max_speed) {
                // What the line had stored has holes, which look like jumps.
                Some(Fault::TooFast)
                    if is_suspended || now - self.interrupted_at < HOLES_SECONDS =>
                {
                    Some(Fault::Suspended)
                }
                fault => fault,
            },
            Reading::Waiting(_) => None,
            Reading::Fault(fault) => Some(*fault),
        };
        let probe = reading.probe();
        let has_modulus = settings.young_modulus > 0.0 && settings.young_modulus.is_finite();
        Findings {
            fault: fault.or((!has_modulus).then_some(Fault::Nan)),
            waiting: match *reading {
                Reading::Waiting(reason) | Reading::Passive(_, reason) => Some(reason),
                _ if tip_fits => None,
                _ if self.has_tool() => Some(reason::OTHER_BODY),
                _ => Some(reason::ONLY_TOOLS),
            },
            switched_off: !settings.enabled,
            body_replaced: moment.body_replaced,
            blind: probe.is_none(),
            button: probe.is_some_and(|p| p.buttons != 0),
            calm: probe.is_none_or(|p| p.speed <= CALM_PART * max_speed),
            ramped: self.safety.is_ramped(),
            ..Findings::default()
        }
    }
}

fn fault_of(probe: &Probe, max_speed: f64) -> Option<Fault> {
    let are_numbers = probe.position.is_finite()
        && probe.orientation.is_finite()
        && probe.speed.is_finite()
        && probe.max_force >= 0.0
        && max_speed.is_finite();
    if !are_numbers {
        Some(Fault::Nan)
    } else if probe.speed > max_speed {
        Some(Fault::TooFast)
    } else {
        None
    }
}
