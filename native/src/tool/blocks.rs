//! Blocks of the compliance between nodes near a tool, kept at hand.
//!
//! A block of a table of hundreds of megabytes costs three waits for memory, one of a compressed
//! table sums over its patterns; under a tool the same few thousand are asked for again and again.

use glam::DMat3;

use crate::body::surface::Body;

/// Places; a tool over 300 nodes needs 45,000.
const PLACES: usize = 1 << 16;
const EMPTY: u64 = u64::MAX;

/// Some blocks of one body.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    places: Vec<(u64, DMat3)>,
    fetched: usize,
}

impl Blocks {
    pub(super) fn new() -> Self {
        Self {
            places: vec![(EMPTY, DMat3::ZERO); PLACES],
            fetched: 0,
        }
    }

    /// How many were not at hand so far.
    #[inline]
    pub(super) fn fetched(&self) -> usize {
        self.fetched
    }

    /// L_ab at unit modulus, zero for a body that does not keep its compliance.
    #[inline]
    pub(super) fn get(&mut self, body: &Body, a: u32, b: u32) -> DMat3 {
        self.kept(a, b, |a, b| body.block(a, b).unwrap_or(DMat3::ZERO))
    }

    /// A block between two nodes that is the transpose of the one between them the other way round.
    #[inline]
    pub(super) fn kept(&mut self, a: u32, b: u32, found: impl FnOnce(u32, u32) -> DMat3) -> DMat3 {
        let (low, high) = (a.min(b), a.max(b));
        let key = u64::from(low) << 32 | u64::from(high);
        // Fibonacci hashing (Knuth 6.4): neighbouring numbers go far apart.
        let place = (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 48) as usize % PLACES;
        let kept = &mut self.places[place];
        if kept.0 != key {
            self.fetched += 1;
            *kept = (key, found(low, high));
        }
        if a <= b { kept.1 } else { kept.1.transpose() }
    }
}
