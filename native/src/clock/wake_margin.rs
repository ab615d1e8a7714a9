//! Margin of time between a thread's timer and its deadline, learned while it runs.
//!
//! Between a timer and the thread that waits for it lie an idle processor's way back and the
//! scheduler. A thread that sets its timer earlier by what this nearly always takes, and busy-waits
//! until the deadline, keeps it more exactly. What is left are the rare long waits.

/// Steps of the margin: 19 of 20 wakings come before the deadline where these balance.
const STEP_DOWN_NS: u64 = 50;
const STEP_UP_NS: u64 = 19 * STEP_DOWN_NS;
/// At most this part of the period is spent busy-waiting: 4 % of one processor. Windows' most exact
/// timers go off twice in a millisecond, so there as much as lies between two of these is learned.
const LARGEST_PART: u64 = if cfg!(windows) { 2 } else { 25 };
/// At most this long, ns: beyond are waits that no busy-waiting saves.
const LARGEST_NS: u64 = if cfg!(windows) { 550_000 } else { 100_000 };

/// Time before the deadline for which a thread sets its timer.
#[derive(Debug)]
pub struct Margin {
    ns: u64,
    largest_ns: u64,
}

impl Margin {
    /// Nothing learned yet; never more than a part of the period.
    pub fn new(period_ns: u64) -> Self {
        Self {
            ns: 0,
            largest_ns: (period_ns / LARGEST_PART).min(LARGEST_NS),
        }
    }

    /// The margin as learned so far, ns.
    pub fn ns(&self) -> u64 {
        self.ns
    }

    /// Learns from a waking that came `latency_ns` after its timer: a small step up where the
    /// margin did not suffice, a 19 times smaller one down where it did, which comes to rest where
    /// 19 of 20 suffice (stochastic approximation of a quantile, Robbins and Monro 1951).
    pub fn learn(&mut self, latency_ns: u64) {
        self.ns = if latency_ns > self.ns {
            (self.ns + STEP_UP_NS).min(self.largest_ns)
        } else {
            self.ns.saturating_sub(STEP_DOWN_NS)
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0 to 9,990 ns, equally often, in an order without pattern.
    fn latency(n: u64) -> u64 {
        (n * 7919 % 1000) * 10
    }

    #[test]
    fn nineteen_of_twenty_wakings_come_before_the_deadline() {
        let mut margin = Margin::new(1_000_000);
        let mut enough = 0;
        for n in 0..20_000 {
            if n >= 10_000 && latency(n) <= margin.ns() {
                enough += 1;
            }
            margin.learn(latency(n));
        }
        assert!((9_300..9_700).contains(&enough), "{enough} of 10,000");
        assert!((8_500..10_500).contains(&margin.ns()), "{} ns", margin.ns());
    }

    #[test]
    fn the_margin_never_exceeds_its_part_of_the_period() {
        let largest = if cfg!(windows) {
            [550_000, 500_000, 62_500]
        } else {
            [100_000, 40_000, 5_000]
        };
        for (period_ns, largest_ns) in [10_000_000, 1_000_000, 125_000].into_iter().zip(largest) {
            let mut margin = Margin::new(period_ns);
            for _ in 0..1000 {
                margin.learn(10_000_000);
            }
            assert_eq!(margin.ns(), largest_ns);
        }
    }

    #[test]
    fn a_machine_that_wakes_at_once_costs_nothing() {
        let mut margin = Margin::new(1_000_000);
        (0..100).for_each(|_| margin.learn(30_000));
        (0..10_000).for_each(|_| margin.learn(0));
        assert_eq!(margin.ns(), 0);
    }
}
