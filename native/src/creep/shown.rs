//! What a body remembers of past forces after one tick, for drawing.

use glam::DVec3;

use super::memory::{MOST_REMEMBERED, Memory};

/// Forces on nodes that would hold the body, were it elastic, as all forces until now have left it.
#[derive(Debug, Clone)]
pub struct Remembered {
    /// The tick; 0 before the first.
    pub tick: u64,
    count: usize,
    nodes: [(u32, DVec3); MOST_REMEMBERED],
}

impl Default for Remembered {
    fn default() -> Self {
        Self {
            tick: 0,
            count: 0,
            nodes: [(0, DVec3::ZERO); MOST_REMEMBERED],
        }
    }
}

impl Remembered {
    /// Nodes of the surface and their forces at the modulus in the end, N.
    pub fn nodes(&self) -> &[(u32, DVec3)] {
        &self.nodes[..self.count]
    }

    /// Becomes what there is after a tick; `young_modulus` in the end, Pa.
    pub fn show(&mut self, tick: u64, memory: &Memory, young_modulus: f64) {
        (self.tick, self.count) = (tick, memory.nodes().len());
        for (shown, node) in self.nodes.iter_mut().zip(memory.nodes()) {
            *shown = (node.number, node.trace.whole() * young_modulus);
        }
    }
}
