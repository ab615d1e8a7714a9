//! How far forces at points move the slots: what is kept of it.

use glam::DMat3;

use crate::algebra::{MOST_POINTS, room};
use crate::contact::cones::MAX_FINGERS;
use crate::tool::blocks::Recent;

/// What is kept of it, and the memory to find it in.
#[derive(Debug, Clone)]
pub(crate) struct Influence {
    pub recent: Recent,
    /// Of each slot: how far a force at each point moves it, m/N at unit modulus.
    pub by_slot: Vec<[DMat3; MAX_FINGERS]>,
    /// How far what they and a tool do to each other is reduced, of each point.
    pub reduced: [f64; MAX_FINGERS],
    /// A column for each axis of each point, and one for the gaps.
    pub columns: Vec<f64>,
}

impl Influence {
    pub(crate) fn new() -> Self {
        Self {
            recent: Recent::new(),
            by_slot: vec![[DMat3::ZERO; MAX_FINGERS]; MOST_POINTS],
            reduced: [1.0; MAX_FINGERS],
            columns: room((3 * MAX_FINGERS + 1) * MOST_POINTS),
        }
    }
}
