//! Normals at the corners of triangles, for a surface that should feel smooth between its facets.
//!
//! A node's normal is the sum of its facets' normals weighted by sin(angle) / (product of the two
//! edge lengths), which is exact for nodes on a sphere (N. Max, "Weights for computing vertex
//! normals from facet normals", Journal of Graphics Tools 4(2), 1999). Edges sharper than
//! [`CREASE`] are meant as edges: they part a node's facets into groups with a normal each.

use glam::DVec3;

use crate::body::face::{Corner, Face, HalfEdge};

/// cos 40 degrees: facets that differ by more meet in a crease.
const CREASE: f64 = 0.766_044_443_118_978;
/// A shared normal must lean less than 84 degrees away from each of its facets.
const LEAST_AGREEMENT: f64 = 0.1;

/// Whether the surface is smooth in intention across this edge.
#[inline]
pub(crate) fn is_soft(faces: &[Face], edge: HalfEdge) -> bool {
    let face = &faces[edge.triangle as usize];
    let other = &faces[face.across[edge.edge as usize].triangle as usize];
    face.normal.dot(other.normal) >= CREASE
}

/// Writes the unit normals of one fan's corners, given counter-clockwise, into `normals`.
pub(crate) fn set_fan_normals(faces: &[Face], fan: &[Corner], normals: &mut [[DVec3; 3]]) {
    let count = fan.len();
    // The edge before corner i in the fan is the one that leaves the node within its triangle.
    let begins_group = |i: usize| {
        let Corner { triangle, corner } = fan[i];
        !is_soft(
            faces,
            HalfEdge {
                triangle,
                edge: corner,
            },
        )
    };
    let first = (0..count).find(|&i| begins_group(i)).unwrap_or(0);
    let mut start = 0;
    while start < count {
        let mut end = start + 1;
        while end < count && !begins_group((first + end) % count) {
            end += 1;
        }
        let group = || (start..end).map(|i| fan[(first + i) % count]);
        let sum: DVec3 = group().map(|c| weighted(faces, c)).sum();
        let shared = sum.try_normalize().filter(|n| {
            group().all(|c| n.dot(faces[c.triangle as usize].normal) > LEAST_AGREEMENT)
        });
        for c in group() {
            normals[c.triangle as usize][c.corner as usize] =
                shared.unwrap_or(faces[c.triangle as usize].normal);
        }
        start = end;
    }
}

fn weighted(faces: &[Face], corner: Corner) -> DVec3 {
    let face = &faces[corner.triangle as usize];
    let c = corner.corner as usize;
    let to_next = face.corners[(c + 1) % 3] - face.corners[c];
    let to_last = face.corners[(c + 2) % 3] - face.corners[c];
    face.area_vector / (to_next.length_squared() * to_last.length_squared())
}
