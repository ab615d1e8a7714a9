//! How far a place is from the curved surface that a body's flat triangles stand for.

use glam::DVec3;

use crate::body::closest::closest_point;
use crate::body::face::closest_on_face;
use crate::body::surface::Body;
use crate::body::tree::Closest;

/// A surface that looks less than this cosine towards the one it meets is not met.
const TOWARDS: f64 = -0.3;
/// Within the body, where the nearest triangle does not, others are met that are by so many times as much
/// farther as a place may be beyond an edge, from half of that on less and less.
const AROUND: f64 = 16.0;

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
    let (closest, normal, kept) = towards(body, &closest, facing)
        .map(|(closest, normal)| (closest, normal, 1.0))
        .or_else(|| around_the_corner(body, place, facing, &closest, beside))?;
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
        presence: (1.0 - beyond_edge / beside) * kept,
    })
}

/// The closest place of another face than the nearest one, the surface's normal there, and how much of
/// it is left, from 1 to 0.
fn around_the_corner(
    body: &Body,
    place: DVec3,
    facing: DVec3,
    nearest: &Closest,
    beside: f64,
) -> Option<(Closest, DVec3, f64)> {
    let outward = body.face(nearest.triangle).normal;
    let is_within = outward.dot(place - nearest.point) < 0.0;
    let around = if is_within { AROUND } else { 1.0 } * beside;
    let other = nearest_towards(body, place, facing, nearest.distance + around)?;
    let (other, normal) = towards(body, &other, facing)?;
    let left = if is_within {
        (2.0 - 2.0 * (other.distance - nearest.distance) / around).min(1.0)
    } else {
        1.0
    };
    Some((other, normal, left))
}

/// The closest place of the triangles that look towards the other, nearer than `reach` m: of any that
/// near, how far the place is beyond an edge would jump from tick to tick.
fn nearest_towards(body: &Body, place: DVec3, facing: DVec3, mut reach: f64) -> Option<Closest> {
    let mut nearest = None;
    let any = |_| true;
    body.tree().visit_within(place, reach, any, |triangle| {
        let face = body.face(triangle);
        if face.normal.dot(facing) < TOWARDS {
            let (alpha, point) = closest_on_face(face, place);
            let distance = point.distance(place);
            if distance < reach {
                reach = distance;
                nearest = Some(Closest {
                    triangle,
                    alpha,
                    point,
                    distance,
                });
            }
        }
        reach
    });
    nearest
}

/// The closest place and the surface's normal there, if it looks towards the other.
fn towards(body: &Body, closest: &Closest, facing: DVec3) -> Option<(Closest, DVec3)> {
    let normals = body.corner_normals(closest.triangle);
    let mean: DVec3 = (0..3).map(|c| normals[c] * closest.alpha[c]).sum();
    let normal = mean.try_normalize()?;
    (normal.dot(facing) < TOWARDS).then_some((*closest, normal))
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::DMat3;

    use super::*;

    const CELLS: i32 = 6;

    /// A cube of one metre about the origin, of many triangles a side.
    fn cube() -> Body {
        let (mut numbers, mut nodes, mut triangles) = (HashMap::new(), Vec::new(), Vec::new());
        let mut number = |at: [i32; 3]| {
            *numbers.entry(at).or_insert_with(|| {
                nodes.push(DVec3::from_array(at.map(f64::from)) / f64::from(CELLS) - 0.5);
                nodes.len() as u32 - 1
            })
        };
        for cell in 0..6 * CELLS * CELLS {
            let (i, j, face) = (cell % CELLS, cell / CELLS % CELLS, cell / CELLS / CELLS);
            let (axis, side) = ((face / 2) as usize, face % 2);
            let [a, mut b, c, mut d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| {
                let mut at = [side * CELLS; 3];
                (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (i + x, j + y);
                number(at)
            });
            if side == 0 {
                (b, d) = (d, b);
            }
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        let blocks = vec![DMat3::IDENTITY; nodes.len()];
        Body::new(nodes, triangles, blocks).expect("sound")
    }

    /// Where another face is nearer, a place beneath the top is met as all others: on it.
    #[test]
    fn a_place_fades_by_how_far_it_is_beyond_the_edge_alone() {
        let (cube, beside) = (cube(), 0.1);
        for step in 0..200 {
            let x = -0.45 + 0.0045 * f64::from(step);
            let depth = 0.01 + 0.0004 * f64::from(step);
            for (beyond, presence) in [(-0.005, 1.0), (0.005, 0.95), (0.05, 0.5)] {
                let place = DVec3::new(x, 0.5 + beyond, 0.5 - depth);
                let met = met(&cube, place, DVec3::NEG_Z, 0, beside).expect("near");
                assert!((met.gap + depth).abs() < 1e-12, "{met:?} at {place}");
                assert!((met.presence - presence).abs() < 1e-9, "{met:?} at {place}");
            }
        }
    }

    /// However near another face is: what was not met would be thrown out as it comes to be.
    #[test]
    fn a_place_deep_beneath_the_top_fades_with_how_much_nearer_another_face_is() {
        let (cube, beside) = (cube(), 0.01);
        let mut before = 1.0;
        for step in 0..200 {
            let depth = 0.002 * f64::from(step);
            let place = DVec3::new(0.1, 0.499, 0.5 - depth);
            let now = met(&cube, place, DVec3::NEG_Z, 0, beside).map_or(0.0, |met| met.presence);
            assert!(now <= before + 1e-12 && before - now < 0.03, "{depth}");
            assert!(now > 1.0 - 1e-9 || depth > 0.08, "{depth}");
            before = now;
        }
        assert_eq!(before, 0.0);
    }
}
