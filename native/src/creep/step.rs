//! What a body that creeps does in one tick, and what a place remembers from tick to tick.
//!
//! In a tick forces are taken to change evenly, for which the integral is exact: what is remembered at
//! its end depends on the memory at its beginning, on the force then, and on that at the end. The
//! last part acts as if the body were a little softer, so that the contact of the tick is one of an
//! elastic body, and no tick is too long for it.

use std::ops::AddAssign;

use glam::{DMat3, DVec3};

use super::term::{MOST_TERMS, Term};

/// One tick of a material; by default of one that does not creep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    kept: [f64; MOST_TERMS],
    /// Of the force at the beginning and at the end of the tick.
    from: [[f64; MOST_TERMS]; 2],
    /// Modulus of the tick over that in the end.
    firmness: f64,
    /// Forces over the modulus at once, of those over that of the tick.
    at_once: f64,
}

impl Default for Step {
    fn default() -> Self {
        Self {
            kept: [0.0; MOST_TERMS],
            from: [[0.0; MOST_TERMS]; 2],
            firmness: 1.0,
            at_once: 1.0,
        }
    }
}

impl Step {
    /// Of a creep series, and E_0 over the modulus in the end less one.
    pub(super) fn new(terms: &[Term; MOST_TERMS], more: f64, dt: f64) -> Self {
        let mut step = Self::default();
        for (k, term) in terms
            .iter()
            .enumerate()
            .filter(|(_, term)| term.share > 0.0)
        {
            let x = dt / term.seconds;
            let (kept, mean) = ((-x).exp(), -(-x).exp_m1() / x);
            step.kept[k] = kept;
            step.from[0][k] = term.share * (mean - kept);
            step.from[1][k] = term.share * (1.0 - mean);
        }
        let now: f64 = step.from[1].iter().sum();
        step.firmness = (1.0 + more) / (1.0 + now);
        step.at_once = 1.0 / (1.0 + now);
        step
    }

    /// Whether nothing is remembered.
    #[inline]
    pub fn is_none(&self) -> bool {
        self.at_once == 1.0 && self.firmness == 1.0
    }

    /// Young's modulus that the contact of the tick is solved with, over that in the end.
    #[inline]
    pub fn firmness(&self) -> f64 {
        self.firmness
    }

    /// Forces over the modulus at once, of forces over that of the tick; displacements alike.
    #[inline]
    pub fn at_once(&self) -> f64 {
        self.at_once
    }
}

/// What a place remembers: of its forces over the modulus at once, m^2, or of displacements, m.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Trace {
    terms: [DVec3; MOST_TERMS],
    last: DVec3,
}

impl Trace {
    /// What will be remembered at the end of a tick, but for what comes in it.
    #[inline]
    pub fn ahead(&self, step: &Step) -> DVec3 {
        let kept = self
            .terms
            .iter()
            .zip(step.kept)
            .map(|(term, share)| *term * share);
        kept.sum::<DVec3>() + self.last * step.from[0].iter().sum::<f64>()
    }

    /// A tick, at the end of which there is `now`.
    #[inline]
    pub fn advance(&mut self, step: &Step, now: DVec3) {
        for (k, term) in self.terms.iter_mut().enumerate() {
            *term = *term * step.kept[k] + self.last * step.from[0][k] + now * step.from[1][k];
        }
        self.last = now;
    }

    /// All of it with what there is now.
    #[inline]
    pub fn whole(&self) -> DVec3 {
        self.terms.iter().sum::<DVec3>() + self.last
    }

    /// Whether there is anything now, besides what is remembered.
    #[inline]
    pub(super) fn is_loaded(&self) -> bool {
        self.last != DVec3::ZERO
    }

    /// The largest component of what is remembered.
    #[inline]
    pub(super) fn size(&self) -> f64 {
        let largest = |most: f64, term: &DVec3| most.max(term.abs().max_element());
        self.terms
            .iter()
            .fold(self.last.abs().max_element(), largest)
    }

    /// What another place remembers of it, by a block of the compliance times a share.
    #[inline]
    #[must_use]
    pub fn seen_by(&self, block: &DMat3) -> Self {
        Self {
            terms: self.terms.map(|term| *block * term),
            last: *block * self.last,
        }
    }
}

impl AddAssign for Trace {
    fn add_assign(&mut self, other: Self) {
        for (term, more) in self.terms.iter_mut().zip(other.terms) {
            *term += more;
        }
        self.last += other.last;
    }
}
