//! Coefficients of friction, and tools as friction has to know them.

use super::shape::Pose;
use super::slot::Slot;
use crate::contact::ground::MOST_TOOLS;

/// Coefficients of friction; zero for none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Friction {
    /// While a point sticks.
    pub sticking: f64,
    /// While it slips, at most the other.
    pub slipping: f64,
}

impl Friction {
    /// The same whether points stick or slip.
    pub fn of(coefficient: f64) -> Self {
        Self {
            sticking: coefficient,
            slipping: coefficient,
        }
    }

    /// Whether there is none at all.
    #[inline]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether both are coefficients.
    #[inline]
    pub fn is_sound(&self) -> bool {
        self.sticking.is_finite() && self.slipping >= 0.0 && self.slipping <= self.sticking
    }

    /// Of a point that slips or sticks.
    #[inline]
    pub(crate) fn of_one(&self, slips: bool) -> f64 {
        if slips { self.slipping } else { self.sticking }
    }

    /// The most that a point bears aside; nothing in the first tick, when it has no anchor yet.
    #[inline]
    pub(super) fn limit(&self, slot: &Slot) -> f64 {
        (slot.anchor).map_or(0.0, |_| self.of_one(slot.slips) * slot.push)
    }
}

/// A tool in one tick, as friction has to know it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Posed {
    pub pose: Pose,
    pub friction: Friction,
    pub reach: f64,
}

/// All tools in one tick, by number.
pub(crate) type AllPosed = [Option<Posed>; MOST_TOOLS];
