//! Absolute deadlines without drift, and what is known about keeping them.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::durations::{DurationReport, Durations, keep_largest, raise};
use crate::sleeper::Sleeper;

const SECOND_NS: u64 = 1_000_000_000;
/// A thread whose work leaves it no time to sleep goes on like that for this long, ns ...
const OVERLOAD_NS: u64 = 20_000_000;
/// ... and then sleeps for this long, so that others live and no watchdog barks, ns.
const REST_NS: u64 = 2_000_000;

/// Lateness limits that are counted one by one, ns.
pub const LATE_LIMITS_NS: [u64; 4] = [10_000, 50_000, 200_000, 1_000_000];

/// Timing counters: written by one thread, read by any, without a lock.
#[derive(Debug, Default)]
pub struct Timing {
    missed: AtomicU64,
    late: [AtomicU64; 4],
    longest_gap_ns: AtomicU64,
    lateness: Durations,
    busy: Durations,
}

/// A reading of [`Timing`].
#[derive(Debug, Clone)]
pub struct TimingReport {
    /// Whole periods that passed without a tick and were skipped.
    pub missed: u64,
    /// Ticks later than each of [`LATE_LIMITS_NS`].
    pub late: [u64; 4],
    /// Longest time between two wakings, ns.
    pub longest_gap_ns: u64,
    /// From the deadline to the waking, one a tick.
    pub lateness: DurationReport,
    /// Time spent working in each tick that has ended.
    pub busy: DurationReport,
}

impl Timing {
    fn record(&self, late_ns: u64, gap_ns: u64, missed: u64) {
        raise(&self.missed, missed);
        for (count, limit) in self.late.iter().zip(LATE_LIMITS_NS) {
            if late_ns > limit {
                raise(count, 1);
            }
        }
        keep_largest(&self.longest_gap_ns, gap_ns);
        self.lateness.record(late_ns);
    }

    /// Counters as they are now.
    pub fn report(&self) -> TimingReport {
        TimingReport {
            missed: self.missed.load(Relaxed),
            late: std::array::from_fn(|i| self.late[i].load(Relaxed)),
            longest_gap_ns: self.longest_gap_ns.load(Relaxed),
            lateness: self.lateness.report(),
            busy: self.busy.report(),
        }
    }
}

impl TimingReport {
    /// Times the thread woke.
    pub fn ticks(&self) -> u64 {
        self.lateness.count
    }
}

/// Deadlines of a rate, exact for as long as anybody wants: their distance from the start is
/// computed anew from their number, so a period that is no whole number of ns adds up to no drift.
#[derive(Debug, Clone, Copy)]
struct Schedule {
    start_ns: u64,
    rate_hz: u64,
}

impl Schedule {
    fn deadline_ns(&self, number: u64) -> u64 {
        let (seconds, rest) = (number / self.rate_hz, number % self.rate_hz);
        self.start_ns + seconds * SECOND_NS + rest * SECOND_NS / self.rate_hz
    }

    /// Number of the last deadline that is not after `now_ns`.
    fn last_before(&self, now_ns: u64) -> u64 {
        let elapsed = now_ns - self.start_ns;
        let (seconds, rest) = (elapsed / SECOND_NS, elapsed % SECOND_NS);
        seconds * self.rate_hz + ((rest + 1) * self.rate_hz - 1) / SECOND_NS
    }

    /// The deadline to wait for after number `number`, at `now_ns`, for a thread that last slept
    /// until `slept_ns`. One that has just passed is kept late; those before it are given up.
    fn after(&self, number: u64, now_ns: u64, slept_ns: u64) -> u64 {
        if now_ns.saturating_sub(slept_ns) > OVERLOAD_NS {
            self.last_before(now_ns + REST_NS) + 1
        } else {
            self.last_before(now_ns).max(number + 1)
        }
    }
}

/// Wakes a thread at a fixed rate.
#[derive(Debug)]
pub struct Pace {
    sleeper: Sleeper,
    schedule: Schedule,
    number: u64,
    woke_ns: u64,
    slept_ns: u64,
}

/// One waking.
#[derive(Debug, Clone, Copy)]
pub struct Wake {
    /// Time since the pace began, s.
    pub seconds: f64,
    /// Whole periods skipped before this one.
    pub missed: u64,
}

impl Pace {
    /// Deadlines from now on, `rate_hz` a second.
    pub fn new(rate_hz: u32) -> Self {
        let sleeper = Sleeper::new();
        let now = sleeper.now_ns();
        Self {
            sleeper,
            schedule: Schedule {
                start_ns: now,
                rate_hz: u64::from(rate_hz.max(1)),
            },
            number: 0,
            woke_ns: now,
            slept_ns: now,
        }
    }

    /// Sleeps until the next deadline and books how well it was kept.
    pub fn wait(&mut self, timing: &Timing) -> Wake {
        let done_ns = self.sleeper.now_ns();
        if self.number > 0 {
            timing.busy.record(done_ns - self.woke_ns);
        }
        let next = self.schedule.after(self.number, done_ns, self.slept_ns);
        let missed = next - self.number - 1;
        self.number = next;
        let deadline_ns = self.schedule.deadline_ns(next);
        self.sleeper.sleep_until(deadline_ns);
        let now = self.sleeper.now_ns();
        if deadline_ns > done_ns {
            self.slept_ns = now;
        }
        timing.record(now.saturating_sub(deadline_ns), now - self.woke_ns, missed);
        self.woke_ns = now;
        Wake {
            seconds: (now - self.schedule.start_ns) as f64 * 1e-9,
            missed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATES: [u64; 8] = [100, 333, 1000, 1234, 3000, 6007, 7999, 8000];

    #[test]
    fn late_ticks_are_counted_by_each_limit() {
        let timing = Timing::default();
        for _ in 0..990 {
            timing.record(5_000, 1_000_000, 0);
        }
        for _ in 0..10 {
            timing.record(300_000, 1_300_000, 2);
        }
        let report = timing.report();
        assert_eq!((report.ticks(), report.missed), (1000, 20));
        assert_eq!(report.late, [10, 10, 10, 0]);
        assert_eq!(report.longest_gap_ns, 1_300_000);
        assert_eq!(report.lateness.percentile_ns(0.999), 300_000);
    }

    #[test]
    fn deadlines_do_not_drift_in_a_year_at_any_rate() {
        const YEAR_S: u64 = 365 * 24 * 3600;
        for rate_hz in RATES {
            let schedule = Schedule {
                start_ns: 123_456_789,
                rate_hz,
            };
            for seconds in [0, 1, 59, 86_400, YEAR_S] {
                let exact = schedule.start_ns + seconds * SECOND_NS;
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
    fn every_deadline_is_kept_or_counted_as_missed() {
        for rate_hz in [1000, 1234, 8000] {
            let timing = Timing::default();
            let mut pace = Pace::new(rate_hz);
            for _ in 0..30 {
                pace.wait(&timing);
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
            let woken = pace.wait(&timing);
            let report = timing.report();
            assert_eq!(report.ticks(), 31);
            assert!(woken.missed >= 4, "{woken:?} at {rate_hz} Hz");
            assert_eq!(pace.number, report.ticks() + report.missed);
            assert!(pace.schedule.deadline_ns(pace.number) <= pace.woke_ns);
        }
    }
}
