//! What bears a body after one tick, for drawing: under it and the fingers' forces it looks as it does.

use glam::DVec3;

use crate::contact::ground::MOST_SUPPORTS;
use crate::tool::slot::MOST_NODES;

/// Forces of all supports on nodes of a body that nobody holds.
#[derive(Debug, Clone)]
pub struct Borne {
    /// The tick; 0 before the first.
    pub tick: u64,
    count: usize,
    nodes: Box<[(u32, DVec3)]>,
}

impl Default for Borne {
    fn default() -> Self {
        Self {
            tick: 0,
            count: 0,
            nodes: vec![(0, DVec3::ZERO); MOST_SUPPORTS * MOST_NODES].into(),
        }
    }
}

impl Borne {
    /// Nodes of the surface and their forces, N, in the body's axes; a node as often as supports
    /// press on it.
    pub fn nodes(&self) -> &[(u32, DVec3)] {
        &self.nodes[..self.count]
    }

    /// Becomes what bears a body in a tick: forces on its nodes, N in its axes. Allocates nothing.
    pub fn show(&mut self, tick: u64, forces: impl Iterator<Item = (u32, DVec3)>) {
        (self.tick, self.count) = (tick, 0);
        for (shown, force) in self.nodes.iter_mut().zip(forces) {
            *shown = force;
            self.count += 1;
        }
    }
}
