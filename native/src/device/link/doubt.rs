//! Protocol 1: whether a device that has heard nothing for a while hears again.
//!
//! It says so itself (FAULT 1), or its port takes nothing. What was said before may still wait on the way,
//! so nothing that pushes is put behind it until the device has answered a HELLO, as it does with each.

/// An answer that comes later is that to an earlier HELLO, s.
const ANSWER_SECONDS: f64 = 0.05;
/// Pause between two HELLO at first; it doubles up to the longest, s.
const PAUSE_SECONDS: f64 = 0.1;
const LONGEST_PAUSE: f64 = 1.0;

/// Doubt about a device, or none.
#[derive(Debug, Clone, Copy, Default)]
pub struct Doubt(Option<Asking>);

#[derive(Debug, Clone, Copy)]
struct Asking {
    /// The last HELLO was said, s.
    asked: f64,
    next: f64,
    pause: f64,
}

impl Doubt {
    /// The device has not heard what was said before `now`, s.
    pub fn begin(&mut self, now: f64) {
        self.0.get_or_insert(Asking {
            asked: f64::NEG_INFINITY,
            // After the zero of this tick.
            next: now + f64::EPSILON * now.abs().max(1.0),
            pause: PAUSE_SECONDS,
        });
    }

    /// Whether nothing that pushes may be said.
    pub fn stands(&self) -> bool {
        self.0.is_some()
    }

    /// Whether it is time for a HELLO, which is said then.
    pub fn asks(&mut self, now: f64) -> bool {
        let Some(asking) = self.0.as_mut().filter(|asking| now >= asking.next) else {
            return false;
        };
        asking.asked = now;
        asking.next = now + asking.pause;
        asking.pause = (2.0 * asking.pause).min(LONGEST_PAUSE);
        true
    }

    /// The device said HELLO.
    pub fn hear(&mut self, now: f64) {
        if let Some(asking) = &self.0
            && now - asking.asked <= ANSWER_SECONDS
        {
            self.0 = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_ends_with_an_answer_in_time_and_with_no_other() {
        let mut doubt = Doubt::default();
        doubt.hear(1.0);
        assert!(!doubt.stands() && !doubt.asks(1.0));
        doubt.begin(1.0);
        assert!(doubt.stands() && !doubt.asks(1.0), "zero is said first");
        doubt.hear(1.0);
        assert!(doubt.stands(), "it was not asked");
        assert!(doubt.asks(1.001));
        doubt.hear(1.06);
        assert!(doubt.stands(), "too late");
        assert!(!doubt.asks(1.09) && doubt.asks(1.11));
        doubt.hear(1.112);
        assert!(!doubt.stands());
    }

    #[test]
    fn a_device_that_hears_nothing_is_asked_less_and_less() {
        let mut doubt = Doubt::default();
        let asked = (0..10_000_u32).filter(|tick| {
            doubt.begin(f64::from(*tick) * 1e-3);
            doubt.asks(f64::from(*tick) * 1e-3)
        });
        // At 0, 0.1, 0.3, 0.7, and then each second.
        assert_eq!(asked.count(), 13);
    }
}
