//! How a point that enters gives way to forces on another: the finite elements, and below their fineness
//! the near field; and how bodies that nobody holds go along as a whole.

use glam::{DMat3, DVec3};

use super::products::{at, carry_otherwise, set};
use super::{Patch, blocks_at};
use crate::algebra::MOST_POINTS;
use crate::contact::ground::Ground;
use crate::contact::mobility::Mobility;
use crate::tool::near_field::NearField;
use crate::tool::points::Point;
use crate::tool::slot::Slot;

impl Patch {
    /// Displacement of the point that enters, the first, per force on another.
    pub(super) fn response(
        &mut self,
        ground: &Ground<'_>,
        near: Option<&NearField>,
        [(point, p), (other, q)]: [(u32, &Point); 2],
    ) -> DMat3 {
        let Some(near) = near else {
            return self.resolved(ground, p, q);
        };
        if point == other {
            let whole = self.resolved(ground, p, q) + near.points[point as usize].own;
            return (whole + whole.transpose()) * 0.5 + near.lifted(point, point);
        }
        let normals = [p.normal, q.normal];
        let share = near.share(point, other, normals);
        let mut sum = near.lifted(point, other);
        if share < 1.0 {
            sum += self.resolved(ground, p, q) * (1.0 - share);
        }
        if share > 0.0 {
            let offset = p.position - q.position;
            let half_space = near.between_points(point, other, offset, normals);
            sum += (self.beyond(ground, near, p, q) + half_space) * share;
        }
        sum
    }

    /// What the finite elements have between the point that enters and another.
    fn resolved(&mut self, ground: &Ground<'_>, entered: &Point, other: &Point) -> DMat3 {
        let (blocks, kept) = (&mut self.blocks, &mut self.of_nodes[0]);
        let mut found = |node: u32| kept.of(node, || entered.mean(|a| blocks.get(ground, a, node)));
        other.mean(&mut found)
    }

    /// What the body does beyond a half-space between the point that enters and another.
    fn beyond(
        &mut self,
        ground: &Ground<'_>,
        near: &NearField,
        entered: &Point,
        other: &Point,
    ) -> DMat3 {
        let (blocks, kept) = (&mut self.beyond, &mut self.of_nodes[1]);
        let body = ground.body;
        let resolved = |a: u32, b: u32| body.block(a, b).unwrap_or(DMat3::ZERO);
        let mut block = |a: u32, b: u32| {
            blocks.kept(ground.number, a, b, |a, b| {
                let offset = body.nodes[a as usize] - body.nodes[b as usize];
                near.beyond(a, b, offset, resolved)
            })
        };
        let mut found = |node: u32| kept.of(node, || entered.mean(|a| block(a, node)));
        other.mean(&mut found)
    }

    /// From now on a body moves otherwise as a whole, and forces act on it where its slots have been moved.
    pub(crate) fn move_otherwise(&mut self, body: u8, [before, now]: [Option<Mobility>; 2]) {
        let is_alike = match (&before, &now) {
            (Some(before), Some(now)) => before.is_alike(now),
            _ => false,
        };
        let own = |slot: &Slot| slot.body == body;
        let stays = |slot: &Slot| slot.at.position + slot.moved == slot.arm;
        if is_alike && self.slots.iter().filter(|slot| own(slot)).all(stays) {
            return;
        }
        let [shift, gone] = [now, before].map(|moves| moves.map_or(0.0, |moves| moves.shift));
        let ways = now.or(before).map_or(DMat3::ZERO, |moves| moves.ways);
        let centre = |moves: Option<Mobility>| moves.map_or(DVec3::ZERO, |moves| moves.centre);
        // Of other bodies' slots all is zero.
        let mut shifts = [0.0; MOST_POINTS];
        let (mut from, mut to) = ([[0.0; MOST_POINTS]; 3], [[0.0; MOST_POINTS]; 3]);
        for (number, slot) in self.slots.iter_mut().enumerate() {
            if own(slot) {
                set(&mut from, number, slot.arm - centre(before));
                slot.arm = slot.at.position + slot.moved;
                set(&mut to, number, slot.arm - centre(now));
                shifts[number] = shift - gone;
            }
        }
        let turns = |moves: Option<Mobility>, arm: DVec3| {
            moves.map_or([[0.0; 3]; 3], |moves| moves.turns(arm).to_cols_array_2d())
        };
        for (number, _) in self.slots.iter().enumerate().filter(|(_, slot)| own(slot)) {
            let change = [
                turns(before, at(&from, number)),
                turns(now, at(&to, number)),
            ];
            let blocks = &mut self.compliance[blocks_at(number)];
            let (shifts, ways) = (&shifts[..=number], ways.to_cols_array_2d());
            carry_otherwise(blocks, shifts, ways, [&from, &to], change);
        }
    }
}
