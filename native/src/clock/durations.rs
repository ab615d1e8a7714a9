//! Durations counted by one thread and read by any, without a lock: mean, largest, percentiles.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

const SUB_BUCKETS: usize = 32;
const SUB_BITS: u32 = 5;
const OCTAVES: usize = 36;
/// Buckets of a histogram, 3 % wide each; the last one starts beyond half an hour.
pub const BUCKETS: usize = SUB_BUCKETS * OCTAVES;

/// Counted durations. One thread writes: the additions are no atomic exchanges.
#[derive(Debug)]
pub struct Durations {
    count: AtomicU64,
    sum_ns: AtomicU64,
    largest_ns: AtomicU64,
    histogram: [AtomicU64; BUCKETS],
}

/// A reading of [`Durations`].
#[derive(Debug, Clone)]
pub struct DurationReport {
    /// Number of durations.
    pub count: u64,
    /// All together, ns.
    pub sum_ns: u64,
    /// The largest, ns.
    pub largest_ns: u64,
    /// Number in each bucket; see [`bucket_limit_ns`].
    pub histogram: Vec<u64>,
}

impl Default for Durations {
    fn default() -> Self {
        Self {
            count: AtomicU64::new(0),
            sum_ns: AtomicU64::new(0),
            largest_ns: AtomicU64::new(0),
            histogram: std::array::from_fn(|_| AtomicU64::new(0)),
        }
    }
}

/// Adds to a counter that only the calling thread writes.
pub(crate) fn raise(counter: &AtomicU64, by: u64) {
    counter.store(counter.load(Relaxed) + by, Relaxed);
}

/// Keeps the largest value in a counter that only the calling thread writes.
pub(crate) fn keep_largest(counter: &AtomicU64, value: u64) {
    if value > counter.load(Relaxed) {
        counter.store(value, Relaxed);
    }
}

impl Durations {
    /// Counts one.
    pub fn record(&self, ns: u64) {
        raise(&self.count, 1);
        raise(&self.sum_ns, ns);
        keep_largest(&self.largest_ns, ns);
        raise(&self.histogram[bucket(ns)], 1);
    }

    /// Number of durations so far.
    pub fn count(&self) -> u64 {
        self.count.load(Relaxed)
    }

    /// All counts so far.
    pub fn report(&self) -> DurationReport {
        DurationReport {
            count: self.count.load(Relaxed),
            sum_ns: self.sum_ns.load(Relaxed),
            largest_ns: self.largest_ns.load(Relaxed),
            histogram: self.histogram.iter().map(|c| c.load(Relaxed)).collect(),
        }
    }
}

impl DurationReport {
    /// Mean, ns; zero of none.
    pub fn mean_ns(&self) -> f64 {
        self.sum_ns as f64 / self.count.max(1) as f64
    }

    /// Duration (ns) that the given part of all does not exceed, to 3 %; zero of none.
    pub fn percentile_ns(&self, part: f64) -> u64 {
        let total: u64 = self.histogram.iter().sum();
        let wanted = ((total as f64) * part).ceil() as u64;
        let mut seen = 0;
        for (i, &count) in self.histogram.iter().enumerate() {
            seen += count;
            if count > 0 && seen >= wanted {
                return bucket_limit_ns(i).min(self.largest_ns);
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

/// Largest duration that falls into a bucket, ns.
pub fn bucket_limit_ns(bucket: usize) -> u64 {
    if bucket < SUB_BUCKETS {
        return bucket as u64;
    }
    let octave = bucket / SUB_BUCKETS - 1;
    let sub = bucket % SUB_BUCKETS + SUB_BUCKETS;
    ((sub as u64 + 1) << octave) - 1
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
    fn mean_percentiles_and_largest_come_from_what_was_counted() {
        let durations = Durations::default();
        assert_eq!(durations.report().percentile_ns(0.99), 0);
        for _ in 0..990 {
            durations.record(5_000);
        }
        for _ in 0..10 {
            durations.record(300_000);
        }
        let report = durations.report();
        assert_eq!((report.count, report.largest_ns), (1000, 300_000));
        assert_eq!(report.mean_ns(), 7_950.0);
        assert!(report.percentile_ns(0.5).abs_diff(5_000) < 200);
        assert!(report.percentile_ns(0.99).abs_diff(5_000) < 200);
        assert_eq!(report.percentile_ns(0.999), 300_000);
    }
}
