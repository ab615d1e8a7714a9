//! How all contacts give way to forces at each other, by all bodies that they share.

use glam::{DMat3, DVec3};

use super::contact::Contact;
use super::member::Member;
use crate::contact::mobility::Mobility;

/// A contact as one body has it.
struct Side {
    contact: usize,
    /// Slots of the body that carry its force, and their shares.
    slots: Vec<(usize, f64)>,
    /// Takes the contact's directions, out and two across, to those of the body, as its force acts there.
    ways: DMat3,
    /// Where the force acts on the body as a whole, m.
    place: DVec3,
}

/// Displacements of some contacts, each out of what it meets and in two directions across, one after the
/// other, under forces along these: `at_rest + matrix force`.
pub(super) struct System {
    /// Row by row, m/N.
    pub matrix: Vec<f64>,
    /// Of no force at all, with what weight does in this tick, m.
    pub at_rest: Vec<f64>,
    /// Of each contact: out, and two directions across, in the world.
    pub directions: Vec<DMat3>,
}

impl System {
    /// The system of the contacts that are `chosen`; the gaps and places of contacts are those under
    /// their forces now. `away` are the contacts' ways now: gap, and from where they stuck.
    pub(super) fn new(
        contacts: &[Contact],
        chosen: &[usize],
        members: &[Member],
        mobilities: &[Option<Mobility>],
        away: &[DVec3],
    ) -> Self {
        let count = chosen.len();
        let directions: Vec<DMat3> = (chosen.iter())
            .map(|&number| {
                let normal = contacts[number].normal;
                let (first, second) = normal.any_orthonormal_pair();
                DMat3::from_cols(normal, first, second)
            })
            .collect();
        let mut system = Self {
            matrix: vec![0.0; 9 * count * count],
            at_rest: away.iter().flat_map(|way| way.to_array()).collect(),
            directions,
        };
        for (body, member) in members.iter().enumerate() {
            let sides = system.sides(contacts, chosen, body, member);
            system.add_body(&sides, member, mobilities[body].as_ref());
        }
        system
    }

    fn sides(
        &self,
        contacts: &[Contact],
        chosen: &[usize],
        body: usize,
        member: &Member,
    ) -> Vec<Side> {
        let mut sides = Vec::new();
        for (place, &number) in chosen.iter().enumerate() {
            let sign = contacts[number].sign_on(body);
            if sign == 0.0 {
                continue;
            }
            let shares = contacts[number].shares_on(body);
            let points = member.surface.points();
            let at = shares
                .iter()
                .map(|&(point, share)| points[point as usize].position * share);
            let turn = DMat3::from_quat(member.placement.rotation.inverse());
            sides.push(Side {
                contact: place,
                place: at.sum(),
                slots: shares
                    .iter()
                    .map(|&(point, share)| (member.slot(point), share))
                    .collect(),
                ways: turn * self.directions[place] * sign,
            });
        }
        sides
    }

    /// Adds what one body does to the contacts that it has.
    fn add_body(&mut self, sides: &[Side], member: &Member, mobility: Option<&Mobility>) {
        let count = self.directions.len();
        let mut moved = vec![DMat3::ZERO; member.slots().len()];
        for loaded in sides {
            moved.fill(DMat3::ZERO);
            for &(slot, share) in &loaded.slots {
                // The block of a slot and another is the transpose of theirs the other way round.
                for (moved, block) in moved.iter_mut().zip(member.between(slot)) {
                    *moved += block.transpose() * loaded.ways * share;
                }
            }
            // What moved so far is the displacement of each slot under unit forces of the contact.
            for seen in sides {
                let mut block: DMat3 = (seen.slots.iter())
                    .map(|&(slot, share)| moved[slot] * share)
                    .fold(DMat3::ZERO, |sum, part| sum + part);
                if let Some(mobility) = mobility {
                    block += mobility.between(seen.place, loaded.place) * loaded.ways;
                }
                let block = seen.ways.transpose() * block;
                for (c, column) in [block.x_axis, block.y_axis, block.z_axis]
                    .iter()
                    .enumerate()
                {
                    for r in 0..3 {
                        let row = 3 * seen.contact + r;
                        self.matrix[row * 3 * count + 3 * loaded.contact + c] += column[r];
                    }
                }
            }
        }
        for side in sides {
            let elastic: DVec3 = (side.slots.iter())
                .map(|&(slot, share)| member.slots()[slot].moved * share)
                .sum();
            let drift = mobility.map_or(DVec3::ZERO, |mobility| mobility.drift);
            let change = side.ways.transpose() * (drift - elastic);
            for axis in 0..3 {
                self.at_rest[3 * side.contact + axis] += change[axis];
            }
        }
    }

    /// A row of the matrix.
    #[inline]
    pub(super) fn row(&self, number: usize) -> &[f64] {
        let count = self.at_rest.len();
        &self.matrix[number * count..][..count]
    }
}
