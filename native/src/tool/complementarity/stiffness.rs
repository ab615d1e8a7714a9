//! How a tool's points resist it, from the factor of those that carry force.

use glam::{DMat3, DVec3};

use super::Complementarity;
use crate::algebra::MOST_POINTS;
use crate::algebra::cholesky::dot;
use crate::control::coupling::largest_eigenvalue;

impl Complementarity {
    /// sum_ij n_i [(N' C N)^-1]_ij n_j' over the unknowns that carry force and have such a normal.
    pub fn stiffness(&mut self, normal: impl Fn(usize) -> Option<DVec3>) -> DMat3 {
        if !self.take_face() {
            return DMat3::ZERO;
        }
        let (face, factor) = self.on_face();
        let mut columns = [[0.0; MOST_POINTS]; 3];
        let mut first = face.len();
        for (place, &unknown) in face.iter().enumerate() {
            if let Some(normal) = normal(unknown) {
                first = first.min(place);
                for (column, n) in columns.iter_mut().zip(normal.to_array()) {
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

/// The stiffness of a tool without friction, with what points that stick add aside: where all stick
/// the tool counts as held on all sides as it is where that is stiffest. More than it is: a patch
/// that sticks is at most nine tenths as stiff aside as into the body (R. D. Mindlin, 1949).
pub(crate) fn with_stuck(stiffness: DMat3, stuck: f64) -> DMat3 {
    if stuck == 0.0 {
        return stiffness;
    }
    let all_round = DMat3::from_diagonal(DVec3::splat(largest_eigenvalue(&stiffness)));
    stiffness + (all_round - stiffness) * stuck
}
