//! Protocol 1: whether a device hears, and in time.
//!
//! The only question that it answers is HELLO, after which it is limp until the next FORCE. So it is asked
//! while nothing is felt anyway. One that does not answer, that says itself that it has heard nothing
//! (FAULT 1), or whose port takes nothing, may find on the way what was said before: nothing that pushes is
//! put behind that until it has answered.

/// An answer that comes later is that to an earlier HELLO, s.
const ANSWER_SECONDS: f64 = 0.05;
/// While nothing is felt it is asked this often, s.
const CHECK_SECONDS: f64 = 1.0;
/// Pause between two HELLO at first; it doubles up to the longest, s.
const PAUSE_SECONDS: f64 = 0.1;
const LONGEST_PAUSE: f64 = 1.0;

/// Doubt about a device, or none.
#[derive(Debug, Clone, Copy)]
pub struct Doubt {
    asking: Option<Asking>,
    /// It was asked without any doubt, s; whether it owes the answer.
    checked: f64,
    is_owed: bool,
}

impl Default for Doubt {
    fn default() -> Self {
        Self {
            asking: None,
            checked: f64::NEG_INFINITY,
            is_owed: false,
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Asking {
    /// The last HELLO was said, s.
    asked: f64,
    next: f64,
    pause: f64,
}

impl Doubt {
    /// Whether to say HELLO now, in the middle of a session in which nothing is felt.
    pub fn checks(&mut self, now: f64) -> bool {
        let is_time = !self.stands() && !self.is_owed && now - self.checked >= CHECK_SECONDS;
        if is_time {
            self.checked = now;
            self.is_owed = true;
        }
        is_time
    }

    /// Whether the answer to that is late.
    pub fn is_unanswered(&self, now: f64) -> bool {
        self.is_owed && now - self.checked > ANSWER_SECONDS
    }

    /// The host was away, or there was silence: that answer is not waited for.
    pub fn excuse(&mut self) {
        self.is_owed = false;
    }

    /// The device has not heard what was said before `now`, s.
    pub fn begin(&mut self, now: f64) {
        self.is_owed = false;
        self.asking.get_or_insert(Asking {
            asked: f64::NEG_INFINITY,
            // After the zero of this tick.
            next: now + f64::EPSILON * now.abs().max(1.0),
            pause: PAUSE_SECONDS,
        });
    }

    /// Whether nothing that pushes may be said.
    pub fn stands(&self) -> bool {
        self.asking.is_some()
    }

    /// Whether it is time for a HELLO, which is said then.
    pub fn asks(&mut self, now: f64) -> bool {
        let Some(asking) = self.asking.as_mut().filter(|asking| now >= asking.next) else {
            return false;
        };
        asking.asked = now;
        asking.next = now + asking.pause;
        asking.pause = (2.0 * asking.pause).min(LONGEST_PAUSE);
        true
    }

    /// The device said HELLO.
    pub fn hear(&mut self, now: f64) {
        self.is_owed = false;
        if let Some(asking) = &self.asking
            && now - asking.asked <= ANSWER_SECONDS
        {
            self.asking = None;
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
    fn it_is_asked_once_a_second_and_what_it_owes_is_late_after_50_ms() {
        let mut doubt = Doubt::default();
        assert!(doubt.checks(1.0) && !doubt.checks(1.001));
        assert!(!doubt.is_unanswered(1.0499) && doubt.is_unanswered(1.051));
        doubt.hear(1.06);
        assert!(!doubt.is_unanswered(1.07) && !doubt.checks(1.9) && doubt.checks(2.0));
        doubt.excuse();
        assert!(!doubt.is_unanswered(3.0) && doubt.checks(3.0));
        doubt.begin(3.1);
        assert!(
            !doubt.is_unanswered(4.0) && !doubt.checks(5.0),
            "it is asked anyway"
        );
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
