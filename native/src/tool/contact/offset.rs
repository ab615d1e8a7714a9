//! How far other fingers move the contact points.

use glam::DVec3;

use super::ToolContact;
use crate::body::closest::closest_point;
use crate::tool::shape::Pose;

impl ToolContact {
    /// Moves all slots by what other fingers do now instead of in the last tick.
    pub(super) fn offset(&mut self, outside: &[(u32, DVec3)], young_modulus: f64) {
        for number in 0..self.patch.slots().len() {
            let offset = self.offset_of(number, outside, young_modulus);
            let slot = &mut self.patch.slots_mut()[number];
            slot.moved += offset - slot.offset;
            slot.offset = offset;
        }
    }

    /// How far other fingers move the surface that is nearest to the tool as they have moved it, m.
    /// Where no point is looked at, the surface under the tool is found from tick to tick: by where
    /// it was carried in the last one.
    pub(super) fn carried_by(
        &mut self,
        pose: &Pose,
        outside: &[(u32, DVec3)],
        young_modulus: f64,
    ) -> DVec3 {
        if outside.is_empty() {
            return DVec3::ZERO;
        }
        let slots = self.patch.slots().iter();
        if let Some(nearest) = slots.min_by(|a, b| a.free.0.total_cmp(&b.free.0)) {
            return nearest.offset;
        }
        let middle = pose.position + pose.rotation * self.tool.middle() - self.carried;
        let (closest, _) = closest_point(self.surface.body(), middle, 0);
        let nodes = self.surface.body().triangles[closest.triangle as usize];
        self.moved_place(nodes, closest.alpha, outside, young_modulus)
    }

    /// Displacement of a slot by other fingers, m.
    pub(super) fn offset_of(
        &mut self,
        number: usize,
        outside: &[(u32, DVec3)],
        young_modulus: f64,
    ) -> DVec3 {
        if outside.is_empty() {
            return DVec3::ZERO;
        }
        let point = *self.patch.point(&self.surface, number);
        self.moved_place(point.nodes, point.alpha, outside, young_modulus)
    }

    /// Displacement of a place in a triangle by other fingers, m.
    fn moved_place(
        &mut self,
        nodes: [u32; 3],
        alpha: [f64; 3],
        outside: &[(u32, DVec3)],
        young_modulus: f64,
    ) -> DVec3 {
        let mut moved = DVec3::ZERO;
        for (node, weight) in nodes.into_iter().zip(alpha) {
            if weight != 0.0 {
                moved += self.moved_node(node, outside) * (weight / young_modulus);
            }
        }
        moved
    }

    /// Displacement of a node at unit modulus, found once a tick.
    fn moved_node(&mut self, node: u32, outside: &[(u32, DVec3)]) -> DVec3 {
        let known = self.moved_nodes[node as usize];
        if known.0 == self.tick {
            return known.1;
        }
        let (blocks, body) = (self.patch.blocks_mut(), self.surface.body());
        let moved = (outside.iter())
            .map(|&(other, force)| blocks.get(body, node, other) * force)
            .sum();
        self.moved_nodes[node as usize] = (self.tick, moved);
        moved
    }
}
