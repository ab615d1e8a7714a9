//! What a tick of all tools may take.

use crate::algebra::{MOST_IN_TICK, MOST_POINTS};
use crate::tool::friction::Sweeping;
use crate::tool::slot::MOST_NEAR;

/// Bounds on the work of a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pace {
    /// Contact points that may be looked at at once, of all tools and of one.
    pub of_all: usize,
    pub of_one: usize,
    /// Linearisations of the contact.
    pub linearisations: usize,
    /// Multiplications for all tools, about, without friction and with it.
    pub work: usize,
    pub work_rubbing: usize,
    /// Of forces aside in one linearisation.
    pub sweeping: Sweeping,
}

impl Pace {
    /// What a tick of 1 kHz has time for; what it leaves the next ones do.
    pub(crate) const IN_TICK: Self = Self {
        of_all: MOST_IN_TICK,
        of_one: MOST_NEAR,
        linearisations: 6,
        work: 500_000,
        work_rubbing: 700_000,
        sweeping: Sweeping::IN_TICK,
    };
    /// Without a clock: all that it takes.
    pub(crate) const UNHURRIED: Self = Self {
        of_all: MOST_POINTS,
        of_one: MOST_POINTS,
        linearisations: 120,
        work: usize::MAX,
        work_rubbing: usize::MAX,
        sweeping: Sweeping::UNHURRIED,
    };

    /// Whether there is no clock.
    pub(crate) fn is_unhurried(&self) -> bool {
        *self == Self::UNHURRIED
    }
}
