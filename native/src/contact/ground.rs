//! A compliant body in a tick, one of a list.

use glam::{DMat3, DVec3};

use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::mobility::Mobility;
use crate::creep::memory::Memory;
use crate::creep::step::Step;

/// Compliant bodies that fingers can touch at once.
pub const MOST_BODIES: usize = 4;
/// Fixed tools that can bear them.
pub const MOST_SUPPORTS: usize = 16;
/// Tools of fingers, by their numbers, and behind them supports.
pub const MOST_TOOLS: usize = MAX_FINGERS + MOST_SUPPORTS;

/// What bodies remember of past forces, by number in the list.
pub type Memories = [Memory; MOST_BODIES];

/// A compliant body in a tick.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// The body.
    pub body: &'a Body,
    /// Another one for each body of the list, and for each that takes its place there.
    pub number: u32,
    /// Of this tick, Pa.
    pub young_modulus: f64,
    /// How it gives way with time in this tick.
    pub creep: Step,
    /// How it moves as a whole, unless it is held.
    pub mobility: Option<Mobility>,
}

impl Ground<'_> {
    /// How far a place goes with the body under a force on another, m/N at unit modulus.
    #[inline]
    pub(crate) fn carried(&self, seen: DVec3, loaded: DVec3) -> DMat3 {
        (self.mobility).map_or(DMat3::ZERO, |mobility| mobility.between(seen, loaded))
    }

    /// The place at rest of area coordinates in a triangle, m.
    #[inline]
    pub(crate) fn place(&self, triangle: u32, alpha: [f64; 3]) -> DVec3 {
        let nodes = self.body.triangles[triangle as usize];
        let corners = nodes.map(|node| self.body.nodes[node as usize]);
        corners.into_iter().zip(alpha).map(|(at, a)| at * a).sum()
    }

    /// How far its weight takes it, m.
    #[inline]
    pub(crate) fn drift(&self) -> DVec3 {
        self.mobility.map_or(DVec3::ZERO, |mobility| mobility.drift)
    }
}
