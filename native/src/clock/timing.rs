//! Waking at a fixed rate, and counters of how well deadlines were kept.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::clock::durations::{DurationReport, Durations, keep_largest, raise};
use crate::clock::schedule::{Phase, SECOND_NS, Schedule};
use crate::clock::sleeper::Sleeper;
use crate::clock::wake_margin::Margin;

/// Lateness limits that are counted one by one, ns.
pub const LATE_LIMITS_NS: [u64; 4] = [10_000, 50_000, 200_000, 1_000_000];

/// Timing counters: written by one thread, read by any, without a lock.
#[derive(Debug, Default)]
pub struct Timing {
    missed: AtomicU64,
    sleeps: AtomicU64,
    late: [AtomicU64; 4],
    longest_gap_ns: AtomicU64,
    lateness: Durations,
    busy: Durations,
    busy_waited: Durations,
}

/// A reading of [`Timing`].
#[derive(Debug, Clone)]
pub struct TimingReport {
    /// Whole periods that passed without a tick and were skipped.
    pub missed: u64,
    /// Times the thread went to sleep until its next deadline: any other time that it gave up its
    /// processor it waited for somebody.
    pub sleeps: u64,
    /// Ticks later than each of [`LATE_LIMITS_NS`].
    pub late: [u64; 4],
    /// Longest time between two wakings, ns.
    pub longest_gap_ns: u64,
    /// From the deadline to the waking, one a tick.
    pub lateness: DurationReport,
    /// Time spent working in each tick that has ended.
    pub busy: DurationReport,
    /// Time spent busy-waiting before each deadline.
    pub busy_waited: DurationReport,
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
            sleeps: self.sleeps.load(Relaxed),
            late: std::array::from_fn(|i| self.late[i].load(Relaxed)),
            longest_gap_ns: self.longest_gap_ns.load(Relaxed),
            lateness: self.lateness.report(),
            busy: self.busy.report(),
            busy_waited: self.busy_waited.report(),
        }
    }
}

impl TimingReport {
    /// Times the thread woke.
    pub fn ticks(&self) -> u64 {
        self.lateness.count
    }
}

/// Way in which a thread waits for its deadline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Waking {
    /// The timer is set to the deadline.
    Timer,
    /// The timer is set a little earlier, by a [`Margin`], and the rest is spent busy-waiting.
    BusyWait,
}

/// Wakes a thread at a fixed rate.
#[derive(Debug)]
pub struct Pace {
    sleeper: Sleeper,
    schedule: Schedule,
    _phase: Phase,
    margin: Option<Margin>,
    begun_ns: u64,
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
    pub fn new(rate_hz: u32, waking: Waking) -> Self {
        let sleeper = Sleeper::new();
        let now = sleeper.now_ns();
        let phase = Phase::claim();
        let schedule = Schedule::new(rate_hz, now, &phase);
        // Busy-waiting takes a processor; where there is only one, it would be everybody's.
        let has_processor_to_spare =
            std::thread::available_parallelism().is_ok_and(|count| count.get() > 1);
        let busy_waits = waking == Waking::BusyWait && has_processor_to_spare;
        Self {
            margin: busy_waits.then(|| Margin::new(SECOND_NS / u64::from(rate_hz.max(1)))),
            number: schedule.last_before(now),
            begun_ns: now,
            woke_ns: now,
            slept_ns: now,
            sleeper,
            schedule,
            _phase: phase,
        }
    }

    /// Sleeps until the next deadline and books how well it was kept; None, and nothing booked, when
    /// no tick `is_wanted` any more by then.
    pub fn wait(&mut self, timing: &Timing, is_wanted: impl FnOnce() -> bool) -> Option<Wake> {
        let done_ns = self.sleeper.now_ns();
        if timing.lateness.count() > 0 {
            timing.busy.record(done_ns - self.woke_ns);
        }
        let next = self.schedule.after(self.number, done_ns, self.slept_ns);
        let missed = next - self.number - 1;
        self.number = next;
        let deadline_ns = self.schedule.deadline_ns(next);
        let now = self.reach(deadline_ns, done_ns, timing);
        if !is_wanted() {
            return None;
        }
        timing.record(now.saturating_sub(deadline_ns), now - self.woke_ns, missed);
        self.woke_ns = now;
        Some(Wake {
            seconds: (now - self.begun_ns) as f64 * 1e-9,
            missed,
        })
    }

    /// Sleeps, and busy-waits for what is left; the time then.
    fn reach(&mut self, deadline_ns: u64, done_ns: u64, timing: &Timing) -> u64 {
        let margin_ns = self.margin.as_ref().map_or(0, Margin::ns);
        let timer_ns = deadline_ns - margin_ns;
        if timer_ns > done_ns {
            raise(&timing.sleeps, 1);
        }
        self.sleeper.sleep_until(timer_ns);
        let mut now = self.sleeper.now_ns();
        if timer_ns > done_ns {
            self.slept_ns = now;
            if let Some(margin) = &mut self.margin {
                margin.learn(now.saturating_sub(timer_ns));
            }
        }
        if self.margin.is_some() {
            timing.busy_waited.record(deadline_ns.saturating_sub(now));
        }
        while now < deadline_ns {
            std::hint::spin_loop();
            now = self.sleeper.now_ns();
        }
        now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn every_deadline_is_kept_or_counted_as_missed() {
        for rate_hz in [1000, 1234, 8000] {
            let timing = Timing::default();
            let mut pace = Pace::new(rate_hz, Waking::BusyWait);
            let before = pace.number;
            for _ in 0..30 {
                pace.wait(&timing, || true);
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
            let woken = pace.wait(&timing, || true).unwrap();
            let report = timing.report();
            assert_eq!(report.ticks(), 31);
            assert!(woken.missed >= 4, "{woken:?} at {rate_hz} Hz");
            assert_eq!(pace.number - before, report.ticks() + report.missed);
            assert!(pace.schedule.deadline_ns(pace.number) <= pace.woke_ns);
        }
    }
}
