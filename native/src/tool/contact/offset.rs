//! How far other fingers move the contact points.

use glam::DVec3;

use super::ToolContact;

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

    /// Displacement of a slot by other fingers, m.
    pub(super) fn offset_of(
        &mut self,
        number: usize,
        outside: &[(u32, DVec3)],
        young_modulus: f64,
    ) -> DVec3 {
        let mut offset = DVec3::ZERO;
        if !outside.is_empty() {
            let point = *self.patch.point(&self.surface, number);
            for (&node, &weight) in point.nodes.iter().zip(&point.alpha) {
                if weight != 0.0 {
                    offset += self.moved_node(node, outside) * (weight / young_modulus);
                }
            }
        }
        offset
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
