//! The contact patch of a finger's tool in one tick, for drawing: it goes its own way beside the
//! snapshot, for it is large, and fingers without a tool have none.

use glam::DVec3;

use crate::rest::frame::Frame;
use crate::rest::placement::Placement;
use crate::tool::collider::Collider;
use crate::tool::slot::{MOST_NEAR, MOST_NODES};

/// A point of the surface that a tool presses.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PressedPoint {
    /// Position now, m.
    pub position: DVec3,
    /// On the body, N.
    pub force: DVec3,
    /// Pa.
    pub pressure: f64,
}

/// All that a tool presses.
#[derive(Debug, Clone)]
pub struct PressedPatch {
    /// The tick; 0 before the first.
    pub tick: u64,
    point_count: usize,
    points: [PressedPoint; MOST_NEAR],
    node_count: usize,
    nodes: [(u32, DVec3); MOST_NODES],
}

impl Default for PressedPatch {
    fn default() -> Self {
        Self {
            tick: 0,
            point_count: 0,
            points: [PressedPoint::default(); MOST_NEAR],
            node_count: 0,
            nodes: [(0, DVec3::ZERO); MOST_NODES],
        }
    }
}

impl PressedPatch {
    /// The points that are pressed.
    pub fn points(&self) -> &[PressedPoint] {
        &self.points[..self.point_count]
    }

    /// Nodes of the surface that carry force, and their forces, N, in the body's axes.
    pub fn nodes(&self) -> &[(u32, DVec3)] {
        &self.nodes[..self.node_count]
    }

    /// Becomes the same in the axes of a body that is placed there.
    pub fn see_from(&mut self, placement: &Placement) {
        for point in &mut self.points[..self.point_count] {
            point.position = placement.place_to_body(point.position);
            point.force = placement.direction_to_body(point.force);
        }
    }

    /// Becomes what a tool presses in a tick, or nothing, on a body whose frame is there now.
    pub fn show(&mut self, tick: u64, tool: Option<&Collider>, frame: &Frame, young_modulus: f64) {
        (self.tick, self.point_count, self.node_count) = (tick, 0, 0);
        let Some(tool) = tool else { return };
        for (point, slot) in self.points.iter_mut().zip(tool.pressed()) {
            let place = &slot.at;
            let force = slot.force * young_modulus;
            *point = PressedPoint {
                position: frame.place(place.position + slot.moved),
                force: frame.direction(force),
                pressure: slot.push * young_modulus / place.area,
            };
            self.point_count += 1;
        }
        for (shown, &(node, force)) in self.nodes.iter_mut().zip(tool.nodal_forces(0)) {
            *shown = (node, force * young_modulus);
            self.node_count += 1;
        }
    }
}
