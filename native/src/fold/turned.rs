//! How a surface is turned, node by node.

use glam::{DMat3, DVec3};

/// Steps of Newton's method; determinants below the second count as that.
const STEPS: usize = 6;
const FLATTEST: f64 = 1e-2;

/// Rotations of nodes from `rest` to where they are `moved`: the mean of those of the `triangles`
/// around each.
pub(super) fn turns(rest: &[DVec3], moved: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DMat3> {
    let mut sums = vec![DMat3::ZERO; rest.len()];
    for corners in triangles {
        let [before, now] =
            [rest, moved].map(|places| frame(corners.map(|node| places[node as usize])));
        let turn = now * before.transpose();
        for &node in corners {
            sums[node as usize] += turn;
        }
    }
    sums.into_iter().map(nearest).collect()
}

/// Axes of a triangle, as columns: along an edge, across, outwards.
fn frame([a, b, c]: [DVec3; 3]) -> DMat3 {
    let out = (b - a).cross(c - a).normalize_or_zero();
    let along = (b - a).normalize_or_zero();
    DMat3::from_cols(along, out.cross(along), out)
}

/// The rotation nearest to a matrix, by Newton's method (N. J. Higham, Computing the polar
/// decomposition, SIAM Journal on Scientific and Statistical Computing 7, 1986); of one that is flat
/// or inside out as near as some steps come.
fn nearest(matrix: DMat3) -> DMat3 {
    let squared: f64 = matrix
        .to_cols_array()
        .iter()
        .map(|entry| entry * entry)
        .sum();
    let mut found = matrix * (3.0 / squared.max(f64::MIN_POSITIVE)).sqrt();
    for _ in 0..STEPS {
        let [x, y, z] = [found.x_axis, found.y_axis, found.z_axis];
        let across = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        let volume = x.dot(across.x_axis).max(FLATTEST);
        found = (found + across * volume.recip()) * 0.5;
    }
    found
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    #[test]
    fn a_stretched_turn_is_that_turn() {
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7)));
        let stretch = DMat3::from_cols(
            DVec3::new(1.3, 0.1, 0.0),
            DVec3::new(0.1, 0.8, 0.05),
            DVec3::new(0.0, 0.05, 1.1),
        );
        assert!(nearest(turn * stretch).abs_diff_eq(turn, 1e-9));
    }
}
