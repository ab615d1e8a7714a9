//! What the tool and the body's nodes feel of the forces at the contact points.

use glam::{DMat3, DVec3};

use super::{Felt, NOWHERE, ToolContact};
use crate::algebra::MOST_POINTS;
use crate::algebra::cholesky::dot;
use crate::control::coupling::largest_eigenvalue;
use crate::tool::shape::Pose;

impl ToolContact {
    /// Sums the forces up.
    pub(super) fn feel(&mut self, pose: &Pose, young_modulus: f64, stuck: f64) {
        let mut felt = Felt::default();
        self.clear_nodes();
        for number in 0..self.patch.slots().len() {
            let slot = self.patch.slots()[number];
            if slot.force == DVec3::ZERO {
                continue;
            }
            let point = self.patch.point(&self.surface, number);
            let arm = point.position + slot.moved - pose.position;
            felt.force -= slot.force * young_modulus;
            felt.torque -= arm.cross(slot.force * young_modulus);
            felt.pressed += 1;
            let (nodes, alpha) = (point.nodes, point.alpha);
            for (&node, &weight) in nodes.iter().zip(&alpha) {
                if weight != 0.0 {
                    self.load(node, slot.force * weight);
                }
            }
        }
        felt.stiffness = with_stuck(self.stiffness(), stuck) * young_modulus;
        self.felt = felt;
    }

    fn load(&mut self, node: u32, force: DVec3) {
        let place = &mut self.place_of[node as usize];
        if *place == NOWHERE {
            *place = self.nodes.len() as u16;
            self.nodes.push((node, force));
        } else {
            self.nodes[*place as usize].1 += force;
        }
    }

    pub(super) fn clear_nodes(&mut self) {
        for (node, _) in self.nodes.drain(..) {
            self.place_of[node as usize] = NOWHERE;
        }
    }

    /// sum_ij n_i [(N' C N)^-1]_ij n_j' over the pressed points, at unit modulus.
    fn stiffness(&mut self) -> DMat3 {
        let Some((face, factor)) = self.problem.factor_on_face() else {
            return DMat3::ZERO;
        };
        let mut columns = [[0.0; MOST_POINTS]; 3];
        for (place, &i) in face.iter().enumerate() {
            let normal = self.patch.slots()[self.chosen[i]].normal;
            for (column, n) in columns.iter_mut().zip(normal.to_array()) {
                column[place] = n;
            }
        }
        for column in &mut columns {
            factor.solve_lower(&mut column[..face.len()]);
        }
        let product =
            |a: usize, b: usize| dot(&columns[a][..face.len()], &columns[b][..face.len()]);
        let [xy, yz, zx] = [product(0, 1), product(1, 2), product(2, 0)];
        DMat3::from_cols(
            DVec3::new(product(0, 0), xy, zx),
            DVec3::new(xy, product(1, 1), yz),
            DVec3::new(zx, yz, product(2, 2)),
        )
    }
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
