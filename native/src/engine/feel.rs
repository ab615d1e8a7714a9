//! What a tool and the body's nodes feel of the forces at the contact points.

use glam::{DMat3, DVec3};

use super::joint::Joint;
use crate::algebra::MOST_POINTS;
use crate::algebra::cholesky::dot;
use crate::control::coupling::largest_eigenvalue;
use crate::tool::collider::{Collider, Felt};
use crate::tool::slot::Slot;

impl Joint {
    /// Adds the forces of a tool on a body; `stuck` of its pushes are on points that stick.
    pub(super) fn feel(
        &mut self,
        pair: [u8; 2],
        collider: &mut Collider,
        young_modulus: f64,
        stuck: f64,
        felt: &mut Felt,
    ) {
        let (before, position) = (
            felt.pressed,
            collider.pose().map_or(DVec3::ZERO, |pose| pose.position),
        );
        let mut given = 0.0;
        for slot in self.patch.slots().iter().filter(|slot| slot.is_of(pair)) {
            if slot.force == DVec3::ZERO {
                continue;
            }
            let arm = slot.at.position + slot.moved - position;
            felt.force -= slot.force * young_modulus;
            felt.torque -= arm.cross(slot.force * young_modulus);
            let moved = self.moved_in_frame(slot);
            felt.energy += held(slot, moved) * young_modulus;
            given -= slot.force.dot(slot.carried) * young_modulus;
            felt.pressed += 1;
            collider.take(Slot { moved, ..*slot });
        }
        if given != 0.0 {
            felt.carried += felt.force * (given / felt.force.length_squared());
        }
        if felt.pressed > before {
            felt.own_energy += self.own_energy(pair) * young_modulus;
            felt.stiffness += with_stuck(self.stiffness(pair), stuck) * young_modulus;
        }
    }

    /// What the pushes of a tool on a body put into it and the springs before it, J at unit modulus.
    fn own_energy(&self, pair: [u8; 2]) -> f64 {
        let mut pushes = [0.0; MOST_POINTS];
        for (push, &number) in pushes.iter_mut().zip(&self.chosen) {
            let slot = &self.patch.slots()[number];
            if slot.is_of(pair) {
                *push = slot.push;
            }
        }
        self.problem.energy_of(&pushes[..self.chosen.len()])
    }

    /// sum_ij n_i [(N' C N)^-1]_ij n_j' over the points of a tool that press a body, at unit modulus.
    fn stiffness(&mut self, pair: [u8; 2]) -> DMat3 {
        if !self.problem.take_face() {
            return DMat3::ZERO;
        }
        let (face, factor) = self.problem.on_face();
        let mut columns = [[0.0; MOST_POINTS]; 3];
        let mut first = face.len();
        for (place, &i) in face.iter().enumerate() {
            let slot = &self.patch.slots()[self.chosen[i]];
            if slot.is_of(pair) {
                first = first.min(place);
                for (column, n) in columns.iter_mut().zip(slot.normal.to_array()) {
                    column[place] = n;
                }
            }
        }
        factor.solve_lower_three(&mut columns, first);
        let product = |a: usize, b: usize| {
            dot(
                &columns[a][first..face.len()],
                &columns[b][first..face.len()],
            )
        };
        let [xy, yz, zx] = [product(0, 1), product(1, 2), product(2, 0)];
        DMat3::from_cols(
            DVec3::new(product(0, 0), xy, zx),
            DVec3::new(xy, product(1, 1), yz),
            DVec3::new(zx, yz, product(2, 2)),
        )
    }
}

/// What a point moved so far holds, J at unit modulus, and with it the spring before it, where the tool is now. A
/// tick whose bound on the work leaves the point a little off the tool has the body hold more or less
/// than that, and the next one, which gets nearer, would seem to give or take the difference.
fn held(slot: &Slot, moved: DVec3) -> f64 {
    let spring = slot.spring * slot.push;
    let off = slot.seen.0 + spring;
    0.5 * (slot.force.dot(moved - slot.remembered) + spring * slot.push) - off * slot.push
}

/// The stiffness of a tool without friction, with what points that stick add aside: where all stick
/// the tool counts as held on all sides as it is where that is stiffest. More than it is: a patch
/// that sticks is at most nine tenths as stiff aside as into the body (R. D. Mindlin, 1949).
fn with_stuck(stiffness: DMat3, stuck: f64) -> DMat3 {
    if stuck == 0.0 {
        return stiffness;
    }
    let all_round = DMat3::from_diagonal(DVec3::splat(largest_eigenvalue(&stiffness)));
    stiffness + (all_round - stiffness) * stuck
}
