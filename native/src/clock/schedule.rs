//! Deadlines of a rate, and where in the period they lie.

use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

pub const SECOND_NS: u64 = 1_000_000_000;
/// A thread whose work leaves it no time to sleep goes on like that for this long, ns ...
const OVERLOAD_NS: u64 = 20_000_000;
/// ... and then sleeps for this long, so that others live and no watchdog barks, ns.
const REST_NS: u64 = 2_000_000;

/// Deadlines of a rate, exact for as long as anybody wants: their distance from the start is
/// computed anew from their number, so a period that is no whole number of ns adds up to no drift.
#[derive(Debug, Clone, Copy)]
pub struct Schedule {
    /// Before the clock's zero, where the clock began a moment ago.
    start_ns: i64,
    rate_hz: u64,
}

impl Schedule {
    /// Counted from the whole second before `now_ns`, shifted by a part of the period: the kernel's
    /// own ticks lie at whole milliseconds of the same clock, and other servos elsewhere. Those of
    /// other processes are not known, so a sixteenth to either side is left to chance.
    pub fn new(rate_hz: u32, now_ns: u64, phase: &Phase) -> Self {
        let rate_hz = u64::from(rate_hz.max(1));
        let sixty_fourths = 8 * phase.eighths() + u64::from(std::process::id() % 9) - 4;
        let shift_ns = SECOND_NS / rate_hz * sixty_fourths / 64;
        Self {
            start_ns: (now_ns - now_ns % SECOND_NS + shift_ns) as i64 - SECOND_NS as i64,
            rate_hz,
        }
    }

    /// When, ns.
    pub fn deadline_ns(&self, number: u64) -> u64 {
        let (seconds, rest) = (number / self.rate_hz, number % self.rate_hz);
        let since_start = seconds * SECOND_NS + rest * SECOND_NS / self.rate_hz;
        since_start.saturating_add_signed(self.start_ns)
    }

    /// Number of the last deadline that is not after `now_ns`.
    pub fn last_before(&self, now_ns: u64) -> u64 {
        let elapsed = (now_ns as i64 - self.start_ns) as u64;
        let (seconds, rest) = (elapsed / SECOND_NS, elapsed % SECOND_NS);
        seconds * self.rate_hz + ((rest + 1) * self.rate_hz - 1) / SECOND_NS
    }

    /// The deadline to wait for after number `number`, at `now_ns`, for a thread that last slept
    /// until `slept_ns`. One that has just passed is kept late; those before it are given up.
    pub fn after(&self, number: u64, now_ns: u64, slept_ns: u64) -> u64 {
        if now_ns.saturating_sub(slept_ns) > OVERLOAD_NS {
            self.last_before(now_ns + REST_NS) + 1
        } else {
            self.last_before(now_ns).max(number + 1)
        }
    }
}

/// A place in the period that no other thread of this process has, as long as there are some left:
/// threads that wake at once wait for each other's work.
#[derive(Debug)]
pub struct Phase(usize);

/// Far from whole milliseconds first, and from each other. In eighths of a period.
const PLACES: [u64; 7] = [2, 6, 4, 1, 5, 3, 7];
static TAKEN: AtomicU8 = AtomicU8::new(0);

impl Phase {
    /// The best free place, or one that is taken where all are.
    pub fn claim() -> Self {
        let free = |taken: u8| taken.trailing_ones() as usize;
        let claim = |taken: u8| (free(taken) < PLACES.len()).then(|| taken | 1 << free(taken));
        match TAKEN.fetch_update(Relaxed, Relaxed, claim) {
            Ok(before) => Self(free(before)),
            Err(_) => Self(PLACES.len()),
        }
    }

    fn eighths(&self) -> u64 {
        PLACES.get(self.0).copied().unwrap_or(PLACES[0])
    }
}

impl Drop for Phase {
    fn drop(&mut self) {
        if self.0 < PLACES.len() {
            TAKEN.fetch_and(!(1 << self.0), Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATES: [u64; 8] = [100, 333, 1000, 1234, 3000, 6007, 7999, 8000];

    #[test]
    fn deadlines_do_not_drift_in_a_year_at_any_rate() {
        const YEAR_S: u64 = 365 * 24 * 3600;
        for rate_hz in RATES {
            let schedule = Schedule {
                start_ns: 123_456_789,
                rate_hz,
            };
            for seconds in [0, 1, 59, 86_400, YEAR_S] {
                let exact = 123_456_789 + seconds * SECOND_NS;
                assert_eq!(
                    schedule.deadline_ns(seconds * rate_hz),
                    exact,
                    "{rate_hz} Hz"
                );
            }
            let period = SECOND_NS / rate_hz;
            for n in (0..2 * rate_hz).chain(YEAR_S * rate_hz..(YEAR_S + 1) * rate_hz) {
                let step = schedule.deadline_ns(n + 1) - schedule.deadline_ns(n);
                assert!(
                    step == period || step == period + 1,
                    "{step} ns at {rate_hz} Hz"
                );
            }
        }
    }

    #[test]
    fn the_last_deadline_before_a_time_is_found() {
        for rate_hz in RATES {
            let schedule = Schedule {
                start_ns: 5,
                rate_hz,
            };
            for n in (0..rate_hz).chain(1_000_000 * rate_hz..1_000_001 * rate_hz) {
                let at = schedule.deadline_ns(n);
                assert_eq!(schedule.last_before(at), n, "{rate_hz} Hz");
                assert_eq!(schedule.last_before(schedule.deadline_ns(n + 1) - 1), n);
            }
        }
    }

    #[test]
    fn a_clock_that_began_a_moment_ago_has_deadlines_too() {
        for now in [0, 1, 999_999, 500_000_000, 999_999_999, SECOND_NS] {
            for rate_hz in [100, 1000, 7999] {
                let schedule = Schedule::new(rate_hz, now, &Phase(0));
                let number = schedule.last_before(now);
                assert!(schedule.deadline_ns(number) <= now);
                let next = schedule.deadline_ns(schedule.after(number, now, now));
                assert!(next > now && next - now <= SECOND_NS / u64::from(rate_hz) + 1);
            }
        }
    }

    #[test]
    fn an_overloaded_thread_sleeps_now_and_then() {
        let schedule = Schedule {
            start_ns: 0,
            rate_hz: 8000,
        };
        let (mut now, mut number, mut slept, mut resting) = (187_500, 0, 0, 0);
        for _ in 0..10_000 {
            let next = schedule.after(number, now, slept);
            assert!(next > number);
            let deadline = schedule.deadline_ns(next);
            if deadline > now {
                assert!(deadline - now > REST_NS && deadline - now <= REST_NS + 125_000);
                resting += deadline - now;
                slept = deadline;
            } else {
                assert!(
                    now - deadline < 125_000,
                    "only the last deadline is kept late"
                );
            }
            number = next;
            // Every tick takes a period and a half.
            now = now.max(deadline) + 187_500;
            assert!(now - slept <= OVERLOAD_NS + 187_500);
        }
        assert!((0.08..0.11).contains(&(resting as f64 / now as f64)));
    }

    #[test]
    fn deadlines_of_two_threads_lie_apart_and_off_whole_milliseconds() {
        // Other tests of this process claim places too: apart is all that may be said of two.
        let (one, other) = (Phase::claim(), Phase::claim());
        assert_ne!(one.eighths(), other.eighths());
        for phase in [&one, &other] {
            let schedule = Schedule::new(1000, 5_123_456_789, phase);
            let next = schedule.deadline_ns(schedule.last_before(5_123_456_789) + 1);
            assert!(next > 5_123_456_789 && next <= 5_124_456_789);
            assert!((next % 1_000_000).abs_diff(125_000 * phase.eighths()) <= 62_500);
            assert!((62_500..=937_500).contains(&(next % 1_000_000)));
        }
    }
}
