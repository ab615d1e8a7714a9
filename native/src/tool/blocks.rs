//! Blocks of compliances between nodes near a tool, kept at hand.
//!
//! A block of a table of hundreds of megabytes costs three waits for memory, one of a compressed
//! table sums over its patterns; under a tool the same few thousand are asked for again and again.

use glam::DMat3;

use crate::contact::ground::Ground;

/// Places; a tool over 300 nodes needs 45,000.
const PLACES: usize = 1 << 16;
const EMPTY: u64 = u64::MAX;

/// Nodes that are told apart, and bodies of those that follow each other.
const NODE_BITS: u32 = 24;

/// Some blocks of some bodies.
#[derive(Debug, Clone)]
pub(crate) struct Blocks {
    places: Vec<(u64, DMat3)>,
    fetched: usize,
}

impl Blocks {
    pub(crate) fn new() -> Self {
        Self {
            places: vec![(EMPTY, DMat3::ZERO); PLACES],
            fetched: 0,
        }
    }

    /// How many were not at hand so far.
    #[inline]
    pub(crate) fn fetched(&self) -> usize {
        self.fetched
    }

    /// L_ab at unit modulus, zero for a body that does not keep its compliance.
    #[inline]
    pub(crate) fn get(&mut self, ground: &Ground<'_>, a: u32, b: u32) -> DMat3 {
        let body = ground.body;
        self.kept(ground.number, a, b, |a, b| {
            body.block(a, b).unwrap_or(DMat3::ZERO)
        })
    }

    /// A block between two nodes of a numbered body that is the transpose of the one between them the other way round.
    #[inline]
    pub(crate) fn kept(
        &mut self,
        body: u32,
        a: u32,
        b: u32,
        found: impl FnOnce(u32, u32) -> DMat3,
    ) -> DMat3 {
        let (low, high) = (a.min(b), a.max(b));
        let key =
            u64::from(body) << (2 * NODE_BITS) | u64::from(low) << NODE_BITS | u64::from(high);
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

/// Nodes that are remembered in one turn.
const REMEMBERED: usize = 1 << 10;

/// What was found for nodes in one turn and is asked for again in it: contact points share nodes.
#[derive(Debug, Clone)]
pub(crate) struct Recent {
    turn: u64,
    places: Vec<(u64, u32, DMat3)>,
}

impl Recent {
    pub(crate) fn new() -> Self {
        Self {
            turn: 0,
            places: vec![(0, 0, DMat3::ZERO); REMEMBERED],
        }
    }

    /// Forgets.
    #[inline]
    pub(crate) fn begin(&mut self) {
        self.turn += 1;
    }

    /// Of a node.
    #[inline]
    pub(crate) fn of(&mut self, node: u32, found: impl FnOnce() -> DMat3) -> DMat3 {
        let place = &mut self.places[node as usize % REMEMBERED];
        if (place.0, place.1) != (self.turn, node) {
            *place = (self.turn, node, found());
        }
        place.2
    }
}
