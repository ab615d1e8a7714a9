//! What a tick of a pile may take.

use crate::algebra::{MOST_IN_TICK, MOST_POINTS};

/// Bounds on the work of a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pace {
    /// Contact points that are looked at of each body, and contacts that may press.
    pub room: usize,
    /// Points that may come to be looked at for contacts that do not press yet.
    pub entering: usize,
    /// Turns of pushes and forces aside.
    pub turns: usize,
    /// Sweeps of forces aside in each.
    pub sweeps: usize,
    /// Multiplications of a solve for the pushes, about.
    pub work: usize,
    /// How bodies give way may be taken from a tick before, in which they lay nearly as they do.
    pub may_keep: bool,
}

impl Pace {
    /// Without a clock: all that it takes.
    pub const UNHURRIED: Self = Self {
        room: MOST_POINTS,
        entering: usize::MAX,
        turns: 6,
        sweeps: 8,
        work: usize::MAX / 4,
        may_keep: false,
    };
    /// What a tick of 1 kHz has time for; what it leaves the next ones do.
    pub const IN_TICK: Self = Self {
        room: MOST_IN_TICK,
        entering: 24,
        turns: 1,
        sweeps: 4,
        work: 500_000,
        may_keep: true,
    };
}
