//! What a tool and the body's nodes feel of the forces at the contact points.

use glam::{DMat3, DVec3};

use super::joint::Joint;
use crate::algebra::MOST_POINTS;
use crate::tool::collider::{Collider, Felt};
use crate::tool::complementarity::stiffness::with_stuck;
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
            felt.remembered += slot.force.dot(slot.remembered) * young_modulus;
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

    /// How the points of a tool that press a body resist it, N/m at unit modulus.
    fn stiffness(&mut self, pair: [u8; 2]) -> DMat3 {
        let (patch, chosen) = (&self.patch, &self.chosen);
        self.problem.stiffness(|unknown| {
            let slot = &patch.slots()[chosen[unknown]];
            slot.is_of(pair).then_some(slot.normal)
        })
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
