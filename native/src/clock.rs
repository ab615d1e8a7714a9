//! Absolute deadlines without drift, and what is known about keeping them.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use crate::sleeper::Sleeper;

/// Lateness limits that are counted one by one, ns.
pub const LATE_LIMITS_NS: [u64; 4] = [10_000, 50_000, 200_000, 1_000_000];

const SUB_BUCKETS: usize = 32;
const SUB_BITS: u32 = 5;
const OCTAVES: usize = 36;
/// Buckets of the lateness histogram, 3 % wide each; the last one starts beyond half an hour.
pub const BUCKETS: usize = SUB_BUCKETS * OCTAVES;

/// Timing counters: written by one thread, read by any, without a lock.
#[derive(Debug)]
pub struct Timing {
    ticks: AtomicU64,
    missed: AtomicU64,
    late: [AtomicU64; 4],
    worst_ns: AtomicU64,
    longest_gap_ns: AtomicU64,
    busiest_ns: AtomicU64,
    busy_ns: AtomicU64,
    histogram: [AtomicU64; BUCKETS],
}

/// A reading of [`Timing`].
#[derive(Debug, Clone)]
pub struct TimingReport {
    /// Times the thread woke.
    pub ticks: u64,
    /// Whole periods that passed without a tick and were skipped.
    pub missed: u64,
    /// Ticks later than each of [`LATE_LIMITS_NS`].
    pub late: [u64; 4],
    /// Largest lateness, ns.
    pub worst_ns: u64,
    /// Longest time between two wakings, ns.
    pub longest_gap_ns: u64,
    /// Longest time spent working in one tick, ns.
    pub busiest_ns: u64,
    /// Time spent working in all ticks, ns.
    pub busy_ns: u64,
    /// Ticks per bucket.
    pub histogram: Vec<u64>,
}

impl Default for Timing {
    fn default() -> Self {
        let zeros = || AtomicU64::new(0);
        Self {
            ticks: zeros(),
            missed: zeros(),
            late: std::array::from_fn(|_| zeros()),
            worst_ns: zeros(),
            longest_gap_ns: zeros(),
            busiest_ns: zeros(),
            busy_ns: zeros(),
            histogram: std::array::from_fn(|_| zeros()),
        }
    }
}

fn raise(counter: &AtomicU64, by: u64) {
    counter.store(counter.load(Relaxed) + by, Relaxed);
}

fn keep_largest(counter: &AtomicU64, value: u64) {
    if value > counter.load(Relaxed) {
        counter.store(value, Relaxed);
    }
}

impl Timing {
    fn record(&self, late_ns: u64, gap_ns: u64, missed: u64) {
        raise(&self.ticks, 1);
        raise(&self.missed, missed);
        for (count, limit) in self.late.iter().zip(LATE_LIMITS_NS) {
            if late_ns > limit {
                raise(count, 1);
            }
        }
        keep_largest(&self.worst_ns, late_ns);
        keep_largest(&self.longest_gap_ns, gap_ns);
        raise(&self.histogram[bucket(late_ns)], 1);
    }

    /// Counters as they are now.
    pub fn report(&self) -> TimingReport {
        TimingReport {
            ticks: self.ticks.load(Relaxed),
            missed: self.missed.load(Relaxed),
            late: std::array::from_fn(|i| self.late[i].load(Relaxed)),
            worst_ns: self.worst_ns.load(Relaxed),
            longest_gap_ns: self.longest_gap_ns.load(Relaxed),
            busiest_ns: self.busiest_ns.load(Relaxed),
            busy_ns: self.busy_ns.load(Relaxed),
            histogram: self.histogram.iter().map(|c| c.load(Relaxed)).collect(),
        }
    }
}

impl TimingReport {
    /// Lateness (ns) that the given part of the ticks does not exceed, to 3 %.
    pub fn percentile_ns(&self, part: f64) -> u64 {
        let total: u64 = self.histogram.iter().sum();
        let wanted = ((total as f64) * part).ceil() as u64;
        let mut seen = 0;
        for (i, &count) in self.histogram.iter().enumerate() {
            seen += count;
            if count > 0 && seen >= wanted {
                return bucket_limit_ns(i).min(self.worst_ns);
            }
        }
        0
    }
}

fn bucket(ns: u64) -> usize {
    if ns < SUB_BUCKETS as u64 {
        return ns as usize;
    }
    let octave = ns.ilog2() - SUB_BITS;
    let sub = (ns >> octave) as usize - SUB_BUCKETS;
    ((octave as usize + 1) * SUB_BUCKETS + sub).min(BUCKETS - 1)
}

/// Largest lateness that falls into a bucket, ns.
pub fn bucket_limit_ns(bucket: usize) -> u64 {
    if bucket < SUB_BUCKETS {
        return bucket as u64;
    }
    let octave = bucket / SUB_BUCKETS - 1;
    let sub = bucket % SUB_BUCKETS + SUB_BUCKETS;
    ((sub as u64 + 1) << octave) - 1
}

/// Wakes a thread at a fixed rate.
#[derive(Debug)]
pub struct Pace {
    sleeper: Sleeper,
    period_ns: u64,
    start_ns: u64,
    deadline_ns: u64,
    woke_ns: u64,
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
            period_ns: 1_000_000_000 / u64::from(rate_hz.max(1)),
            start_ns: now,
            deadline_ns: now,
            woke_ns: now,
        }
    }

    /// Sleeps until the next deadline and books how well it was kept.
    pub fn wait(&mut self, timing: &Timing) -> Wake {
        let done_ns = self.sleeper.now_ns();
        let busy = done_ns - self.woke_ns;
        keep_largest(&timing.busiest_ns, busy);
        raise(&timing.busy_ns, busy);
        self.deadline_ns += self.period_ns;
        let missed = done_ns.saturating_sub(self.deadline_ns) / self.period_ns;
        self.deadline_ns += missed * self.period_ns;
        self.sleeper.sleep_until(self.deadline_ns);
        let now = self.sleeper.now_ns();
        timing.record(
            now.saturating_sub(self.deadline_ns),
            now - self.woke_ns,
            missed,
        );
        self.woke_ns = now;
        Wake {
            seconds: (now - self.start_ns) as f64 * 1e-9,
            missed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_are_ordered_and_three_percent_wide() {
        let mut last = 0;
        for ns in (0..2000).chain((11..40).flat_map(|e| {
            let base = 1_u64 << e;
            [base - 1, base, base + base / 3]
        })) {
            let b = bucket(ns);
            assert!(b >= last);
            last = b;
            assert!(bucket_limit_ns(b) >= ns);
            assert!(bucket_limit_ns(b) as f64 <= ns as f64 * 1.032 + 1.0);
        }
    }

    #[test]
    fn percentiles_come_from_the_counted_ticks() {
        let timing = Timing::default();
        for _ in 0..990 {
            timing.record(5_000, 1_000_000, 0);
        }
        for _ in 0..10 {
            timing.record(300_000, 1_000_000, 2);
        }
        let report = timing.report();
        assert_eq!((report.ticks, report.missed), (1000, 20));
        assert_eq!(report.late, [10, 10, 10, 0]);
        assert!(report.percentile_ns(0.5).abs_diff(5_000) < 200);
        assert_eq!(report.percentile_ns(0.999), 300_000);
    }

    #[test]
    fn a_pace_does_not_drift() {
        let timing = Timing::default();
        let mut pace = Pace::new(1000);
        let start = pace.deadline_ns;
        for _ in 0..50 {
            pace.wait(&timing);
        }
        let report = timing.report();
        assert_eq!(report.ticks, 50);
        let periods = (pace.deadline_ns - start) / pace.period_ns;
        assert_eq!(periods, report.ticks + report.missed);
        assert_eq!((pace.deadline_ns - start) % pace.period_ns, 0);
    }
}
