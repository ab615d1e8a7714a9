//! What bears bodies after one tick, for drawing: under it and the fingers' forces they look as they do.

use glam::DVec3;

use crate::contact::ground::MOST_BODIES;

/// Forces on nodes of one body that are told; more than a tick has.
pub const MOST_BORNE: usize = 10_000;

/// Forces on nodes of a body that nobody holds, and of those that it presses.
#[derive(Debug, Clone, Default)]
pub struct Borne {
    /// The tick; 0 before the first.
    pub tick: u64,
    bodies: [Forces; MOST_BODIES],
}

/// Forces on nodes of one body.
#[derive(Debug, Clone)]
struct Forces {
    count: usize,
    nodes: Box<[(u32, DVec3)]>,
}

impl Default for Forces {
    fn default() -> Self {
        Self {
            count: 0,
            nodes: vec![(0, DVec3::ZERO); MOST_BORNE].into(),
        }
    }
}

impl Borne {
    /// Nodes of the surface of a body, the touched one first, and their forces, N, in the body's
    /// axes; a node as often as something presses on it.
    pub fn nodes(&self, body: usize) -> &[(u32, DVec3)] {
        let Forces { count, nodes } = &self.bodies[body];
        &nodes[..*count]
    }

    /// The same of the touched body and those after it.
    pub fn of_bodies(&self, count: usize) -> Vec<Vec<(u32, DVec3)>> {
        (0..count).map(|body| self.nodes(body).to_vec()).collect()
    }

    /// Becomes what bears a body in a tick: forces on its nodes, N in its axes. Allocates nothing.
    pub fn show(&mut self, body: usize, forces: impl Iterator<Item = (u32, DVec3)>) {
        let Forces { count, nodes } = &mut self.bodies[body];
        *count = 0;
        // One after the other from within: forces that come from several places are told apart once each.
        forces.take(nodes.len()).for_each(|force| {
            nodes[*count] = force;
            *count += 1;
        });
    }

    /// Becomes that of a tick in which nothing bears any.
    pub fn clear(&mut self, tick: u64) {
        self.tick = tick;
        for body in &mut self.bodies {
            body.count = 0;
        }
    }
}
