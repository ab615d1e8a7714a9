//! How far a place is from the curved surface that a body's flat triangles stand for.

use glam::DVec3;

use crate::body::closest::closest_point;
use crate::body::surface::Body;
use crate::body::tree::Closest;

/// A surface that looks less than this cosine towards the one it meets is not met.
const TOWARDS: f64 = -0.3;

/// A place near the surface of a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Met {
    /// From the surface, m, negative inside.
    pub gap: f64,
    /// Out of the body there.
    pub normal: DVec3,
    pub triangle: u32,
    /// From 1 on it to 0 where it is so far beyond an edge that it meets nothing.
    pub presence: f64,
}

/// How a place of another body, whose surface looks along `facing` there, is met; all in the body's
/// frame. Nothing beyond an edge by more than `beside` m, or where both look the same way.
///
/// Half of the mean way to the tangent planes of a triangle's corners is what its curved surface lies
/// beyond it, exact to second order, as contact points do.
pub(super) fn met(
    body: &Body,
    place: DVec3,
    facing: DVec3,
    triangle: u32,
    beside: f64,
) -> Option<Met> {
    let (closest, _) = closest_point(body, place, triangle);
    let found = towards(body, &closest, facing).or_else(|| {
        // At an edge the nearest triangle may be the one around the corner.
        let is_wanted = |face: &crate::body::face::Face, _: f64| face.normal.dot(facing) < TOWARDS;
        let reach = closest.distance + beside;
        let other = (body.tree()).find_within(body.faces(), place, reach, is_wanted)?;
        towards(body, &other, facing)
    });
    let (closest, normal) = found?;
    let way = place - closest.point;
    let along = normal.dot(way);
    let beyond_edge = (way - normal * along).length();
    if beyond_edge > beside {
        return None;
    }
    let corners = body.face(closest.triangle).corners;
    let normals = body.corner_normals(closest.triangle);
    let beyond: f64 = (0..3)
        .map(|c| closest.alpha[c] * (corners[c] - closest.point).dot(normals[c]))
        .sum();
    Some(Met {
        gap: along - 0.5 * beyond,
        normal,
        triangle: closest.triangle,
        presence: 1.0 - beyond_edge / beside,
    })
}

/// The closest place and the surface's normal there, if it looks towards the other.
fn towards(body: &Body, closest: &Closest, facing: DVec3) -> Option<(Closest, DVec3)> {
    let normals = body.corner_normals(closest.triangle);
    let mean: DVec3 = (0..3).map(|c| normals[c] * closest.alpha[c]).sum();
    let normal = mean.try_normalize()?;
    (normal.dot(facing) < TOWARDS).then_some((*closest, normal))
}
