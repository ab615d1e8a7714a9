//! Durations of the parts of a tick.

use std::time::Instant;

use crate::clock::durations::{DurationReport, Durations};

/// A part of the tick, in the order of the tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Settings and the device's newest position.
    Read,
    /// The god object.
    Proxy,
    /// Force of the contact, (11) to (15).
    Contact,
    /// Everything between the contact and the motors, and the device itself.
    Write,
}

impl Stage {
    /// All stages, in order.
    pub const ALL: [Self; 4] = [Self::Read, Self::Proxy, Self::Contact, Self::Write];

    /// Name for people and counters.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Proxy => "proxy",
            Self::Contact => "contact",
            Self::Write => "write",
        }
    }
}

/// Time spent in each stage: written by the servo's thread, read by any, without a lock.
#[derive(Debug, Default)]
pub struct Stages {
    durations: [Durations; Stage::ALL.len()],
}

impl Stages {
    /// Books the time since `since` (monotonic) for `stage`, which ends now; the next begins.
    pub fn end_of(&self, stage: Stage, since: &mut Instant) {
        let now = Instant::now();
        let spent = now.saturating_duration_since(*since);
        self.durations[stage as usize].record(spent.as_nanos() as u64);
        *since = now;
    }

    /// Times of one stage so far.
    pub fn report(&self, stage: Stage) -> DurationReport {
        self.durations[stage as usize].report()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stage_gets_the_time_until_its_own_end() {
        let stages = Stages::default();
        let begin = Instant::now();
        let mut since = begin;
        stages.end_of(Stage::Read, &mut since);
        std::thread::sleep(std::time::Duration::from_millis(2));
        stages.end_of(Stage::Proxy, &mut since);
        stages.end_of(Stage::Contact, &mut since);
        stages.end_of(Stage::Write, &mut since);
        let whole = begin.elapsed().as_nanos() as u64;
        let spent = Stage::ALL.map(|stage| stages.report(stage));
        assert!(spent.iter().all(|s| s.count == 1));
        assert!(spent[1].largest_ns >= 2_000_000);
        assert!(spent.iter().map(|s| s.sum_ns).sum::<u64>() <= whole);
        assert!(spent[0].sum_ns + spent[2].sum_ns + spent[3].sum_ns <= whole - 2_000_000);
    }
}
