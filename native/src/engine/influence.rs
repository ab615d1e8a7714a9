//! What points do to the tools' contact points, and what these do to them.
//!
//! On the slots that carry force the tools answer linearly to the points' forces F. With A of these
//! slots, b_p how far a force at p moves them along the tools' normals, and g their gaps without the
//! points, pushes are f = -A^-1 (g + b F), and the surface at p moves by b_p' f. So the points find it
//! as if it had other places and a smaller compliance, and are solved by themselves: the answer is
//! exact for all, as long as the same slots carry force.

use glam::{DMat3, DVec3};

use super::joint::{Beside, Joint};
use crate::algebra::MOST_POINTS;
use crate::algebra::cholesky::dot;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::{Ground, MOST_BODIES};
use crate::contact::mobility::Mobility;
use crate::contact::touch::{contact_compliance, inverse_of_definite};
use crate::control::coupling::largest_eigenvalue;
use crate::fingers::press::{Press, Reaction, numbered};
use crate::tool::slot::Slot;

/// Of what a point gives way alone tools take this share at most: on one place with a tool it would
/// else not give way at all, and have no end of force. What they do to each other is reduced for that.
const MOST_TAKEN: f64 = 0.98;
/// Turns of points and tools in one linearisation.
const MOST_TURNS: usize = 4;

impl Joint {
    /// Moves all slots by what the points do where they are now, with the forces of the last tick, and
    /// by what is remembered.
    pub(super) fn offset(&mut self, grounds: &[Ground<'_>], beside: &Beside<'_>) {
        self.find_influence(grounds, beside);
        self.remember(beside.memories);
        for place in 0..self.patch.slots().len() {
            let offset = self.offset_of(place, beside);
            let slot = &mut self.patch.slots_mut()[place];
            slot.moved += offset - slot.offset;
            slot.offset = offset;
        }
    }

    /// How far the points move each slot.
    pub(super) fn find_influence(&mut self, grounds: &[Ground<'_>], beside: &Beside<'_>) {
        for (p, press) in numbered(beside.presses) {
            self.influence.recent.begin();
            for place in 0..self.patch.slots().len() {
                let found = self.influence_on(place, grounds, &press);
                self.influence.by_slot[place][p] = found;
            }
        }
    }

    fn influence_on(&mut self, place: usize, grounds: &[Ground<'_>], press: &Press) -> DMat3 {
        let Slot { at, arm, body, .. } = self.patch.slots()[place];
        let Some(ground) = grounds
            .get(usize::from(body))
            .filter(|_| body == press.body)
        else {
            return DMat3::ZERO;
        };
        let nodes = ground.body.triangles[press.hold.triangle as usize];
        let from = ground.place(press.hold.triangle, press.hold.alpha);
        let carried = ground.carried(arm, from);
        let (recent, blocks) = (&mut self.influence.recent, self.patch.blocks_mut());
        let mut of_node = |seen: u32| {
            let mut sum = DMat3::ZERO;
            for (loaded, weight) in nodes.into_iter().zip(press.hold.alpha) {
                if weight != 0.0 {
                    sum += blocks.get(ground, seen, loaded) * weight;
                }
            }
            sum
        };
        at.mean(|seen| recent.of(seen, || of_node(seen))) + carried
    }

    /// The same for a slot that has just come in.
    pub(super) fn offset_one(&mut self, place: usize, grounds: &[Ground<'_>], beside: &Beside<'_>) {
        for (p, press) in numbered(beside.presses) {
            self.influence.recent.begin();
            let found = self.influence_on(place, grounds, &press);
            self.influence.by_slot[place][p] = found;
        }
        self.recall(place, grounds, beside.memories);
        self.patch.slots_mut()[place].offset = self.offset_of(place, beside);
    }

    /// How far the points, past forces and the body's weight move a slot, m.
    fn offset_of(&self, place: usize, beside: &Beside<'_>) -> DVec3 {
        let (forces, by_slot) = (beside.several.forces(), &self.influence.by_slot[place]);
        let by_points = numbered(beside.presses)
            .filter(|(_, press)| press.touches)
            .map(|(p, _)| by_slot[p] * forces[p] * self.influence.reduced[p]);
        let slot = &self.patch.slots()[place];
        drift(&self.mobilities, slot) + slot.remembered + by_points.sum::<DVec3>()
    }

    /// How far points move a place in a triangle, m.
    pub(super) fn moved_by_points(
        &mut self,
        (body, ground): (usize, &Ground<'_>),
        beside: &Beside<'_>,
        nodes: [u32; 3],
        alpha: [f64; 3],
    ) -> DVec3 {
        let forces = beside.several.forces();
        let mut moved = DVec3::ZERO;
        let acts = |press: &Press| press.touches && usize::from(press.body) == body;
        for (p, press) in numbered(beside.presses).filter(|(_, press)| acts(press)) {
            let loaded = ground.body.triangles[press.hold.triangle as usize];
            for (node, weight) in nodes.into_iter().zip(alpha) {
                for (other, share) in loaded.into_iter().zip(press.hold.alpha) {
                    let block = self.patch.blocks_mut().get(ground, node, other);
                    moved += block * forces[p] * (weight * share);
                }
            }
        }
        moved
    }

    /// Finds the points' forces together with the pushes, which are those without them so far; whether
    /// both are found.
    pub(super) fn meet_points(
        &mut self,
        grounds: &[Ground<'_>],
        beside: &mut Beside<'_>,
        most_work: usize,
    ) -> bool {
        if beside.presses.iter().all(Option::is_none) {
            return true;
        }
        for _ in 0..MOST_TURNS {
            let reaction = self.reaction(grounds, beside);
            let (several, presses) = (&mut *beside.several, beside.presses);
            let mut answers = several.solve(grounds, presses, &reaction);
            if answers.is_none() {
                self.influence.reduced = [0.0; MAX_FINGERS];
                let none = Reaction::default();
                answers = several.solve(grounds, presses, &none);
            }
            if answers.is_none() {
                return true;
            }
            beside.answers = answers;
            self.take_offsets(beside);
            let faces = self.problem.faces();
            self.problem.solve(most_work);
            if self.problem.faces() == faces {
                return true;
            }
        }
        false
    }

    /// Brings offsets and gaps to the points' new forces.
    fn take_offsets(&mut self, beside: &Beside<'_>) {
        for place in 0..self.patch.slots().len() {
            let offset = self.offset_of(place, beside);
            let slot = &mut self.patch.slots_mut()[place];
            (slot.before, slot.offset) = (slot.offset, offset);
        }
        for (unknown, &place) in self.chosen.iter().enumerate() {
            let slot = &self.patch.slots()[place];
            self.problem.gaps[unknown] += slot.normal.dot(slot.offset - slot.before);
        }
    }

    /// How the tools answer to the points' forces, on the slots that carry force now.
    fn reaction(&mut self, grounds: &[Ground<'_>], beside: &Beside<'_>) -> Reaction {
        let mut reaction = Reaction::default();
        if !self.problem.take_face() {
            return reaction;
        }
        let (face, factor) = self.problem.on_face();
        let size = face.len();
        let (slots, by_slot) = (self.patch.slots(), &self.influence.by_slot);
        let gaps = &self.problem.gaps;
        let columns = &mut self.influence.columns;
        let (last, first) = columns.split_at_mut(MOST_POINTS);
        for (k, &unknown) in face.iter().enumerate() {
            let slot = &slots[self.chosen[unknown]];
            let by_points = slot.offset - drift(&self.mobilities, slot);
            last[k] = gaps[unknown] - slot.normal.dot(by_points);
            for (p, _) in numbered(beside.presses) {
                let along = by_slot[self.chosen[unknown]][p].transpose() * slot.normal;
                for axis in 0..3 {
                    first[(3 * p + axis) * MOST_POINTS + k] = along[axis];
                }
            }
        }
        factor.solve_lower(&mut last[..size]);
        for (p, _) in numbered(beside.presses) {
            for axis in 0..3 {
                factor.solve_lower(&mut first[(3 * p + axis) * MOST_POINTS..][..size]);
            }
        }
        let column = |p: usize, axis: usize| &first[(3 * p + axis) * MOST_POINTS..][..size];
        for (p, _) in numbered(beside.presses) {
            let mut moved = DVec3::ZERO;
            for axis in 0..3 {
                moved[axis] = -dot(column(p, axis), &last[..size]);
            }
            for (slot, by_slot) in slots.iter().zip(by_slot) {
                if slot.aside != DVec3::ZERO {
                    moved += by_slot[p].transpose() * slot.aside;
                }
            }
            reaction.moved[p] = moved;
            for (q, _) in numbered(beside.presses) {
                let entry = |c: usize, r: usize| -dot(column(p, r), column(q, c));
                reaction.by[p][q] =
                    DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| entry(c, r))));
            }
        }
        for (p, press) in numbered(beside.presses) {
            let own = (grounds.get(usize::from(press.body))).and_then(|ground| {
                let at = ground.place(press.hold.triangle, press.hold.alpha);
                contact_compliance(ground.body, press.hold.triangle, press.hold.alpha)
                    // Of how the body as a whole gives way tools may take all.
                    .map(|own| own + ground.carried(at, at) * (1.0 / MOST_TAKEN))
            });
            let taken = own.map_or(0.0, |own| share_taken(&own, &-reaction.by[p][p]));
            self.influence.reduced[p] = (MOST_TAKEN / taken).sqrt().min(1.0);
        }
        reaction.reduce(&self.influence.reduced);
        reaction
    }
}

/// How far its weight takes the body of a slot, m.
fn drift(mobilities: &[Option<Mobility>; MOST_BODIES], slot: &Slot) -> DVec3 {
    let mobility = mobilities[usize::from(slot.body)];
    mobility.map_or(DVec3::ZERO, |mobility| mobility.drift)
}

/// The largest share of a compliance that is taken, in any direction.
fn share_taken(own: &DMat3, taken: &DMat3) -> f64 {
    // C^-1 R has the principal values of L^-1 R L^-T, which is symmetric, with C = L L'.
    let Some(lower) = lower_root(own) else {
        return 0.0;
    };
    let inverse = lower.inverse();
    largest_eigenvalue(&(inverse * *taken * inverse.transpose()))
}

/// L with L L' the symmetric matrix; `None` unless that is definite.
fn lower_root(matrix: &DMat3) -> Option<DMat3> {
    inverse_of_definite(matrix)?;
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let a = x.x.sqrt();
    let (b, c) = (x.y / a, x.z / a);
    let d = (y.y - b * b).sqrt();
    let e = (y.z - b * c) / d;
    let f = (z.z - c * c - e * e).sqrt();
    Some(DMat3::from_cols(
        DVec3::new(a, b, c),
        DVec3::new(0.0, d, e),
        DVec3::new(0.0, 0.0, f),
    ))
}
