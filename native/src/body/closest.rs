//! Signed distance to the surface, and the closest places to many points.

use std::num::NonZero;
use std::thread;

use glam::DVec3;

use crate::body::error::BodyError;
use crate::body::face::{Face, measure_faces};
use crate::body::surface::Body;
use crate::body::tree::{Closest, Tree};

/// Nearest surface point and whether `p` lies inside the body.
///
/// The sign is that of the angle-weighted pseudonormal of the nearest feature
/// (Baerentzen and Aanaes 2005); a point exactly on the surface counts as outside.
pub fn closest_point(body: &Body, p: DVec3, hint: u32) -> (Closest, bool) {
    let closest = body.tree().closest(body.faces(), p, hint);
    let inside = is_behind(body, closest.triangle, closest.alpha, closest.point, p);
    (closest, inside)
}

/// Another face as near as `distance`, to within `rounding`, that has `p` straight behind it.
///
/// Where faces of two parts coincide the nearest face alone cannot tell the sign: outside of the
/// one part is inside of the other.
pub(crate) fn coincident_face(
    body: &Body,
    p: DVec3,
    distance: f64,
    rounding: f64,
) -> Option<Closest> {
    let is_behind = |face: &Face, distance: f64| {
        let height = face.normal.dot(p - face.corners[0]);
        height <= rounding - distance && face.side(p) < 0.0
    };
    (body.tree()).find_within(body.faces(), p, distance + rounding, is_behind)
}

fn is_behind(body: &Body, triangle: u32, alpha: [f64; 3], point: DVec3, p: DVec3) -> bool {
    let on_border = alpha.map(|a| a == 0.0);
    match on_border {
        [false, true, true] | [true, false, true] | [true, true, false] => {
            let corner = on_border.iter().position(|z| !z).unwrap_or(0);
            let node = body.triangles[triangle as usize][corner];
            body.node_normal(node).dot(p - point) < 0.0
        }
        [true, false, false] => body.edge_normal(triangle, 1).dot(p - point) < 0.0,
        [false, true, false] => body.edge_normal(triangle, 2).dot(p - point) < 0.0,
        [false, false, true] => body.edge_normal(triangle, 0).dot(p - point) < 0.0,
        _ => body.face(triangle).side(p) < 0.0,
    }
}

/// Fewer points are not worth a thread of their own.
const POINTS_A_THREAD: usize = 4096;

/// Nearest surface point of each of `points`, by all cores; neighbours in the list that lie near
/// each other are quick. For work that is not the tick's.
pub fn closest_points(
    nodes: &[DVec3],
    triangles: &[[u32; 3]],
    points: &[DVec3],
) -> Result<Vec<Closest>, BodyError> {
    if triangles.is_empty() {
        return Err(BodyError(
            "there are no triangles; give at least one".to_owned(),
        ));
    }
    let faces = measure_faces(nodes, triangles)?;
    let tree = Tree::new(&faces);
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let share = points.len().div_ceil(cores).max(POINTS_A_THREAD);
    let found = thread::scope(|scope| {
        let parts: Vec<_> = points
            .chunks(share)
            .map(|part| scope.spawn(|| in_turn(&tree, &faces, part)))
            .collect();
        parts
            .into_iter()
            .flat_map(|part| {
                part.join()
                    .expect("a search for closest points does not panic")
            })
            .collect()
    });
    Ok(found)
}

fn in_turn(tree: &Tree, faces: &[Face], points: &[DVec3]) -> Vec<Closest> {
    let mut hint = 0;
    points
        .iter()
        .map(|&p| {
            let found = tree.closest(faces, p, hint);
            hint = found.triangle;
            found
        })
        .collect()
}
