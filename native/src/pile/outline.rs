//! How far a place is from the curved surface that a body's flat triangles stand for.

#[cfg(test)]
mod cube;
pub(super) mod known;
pub(super) mod looks;

use glam::DVec3;

use crate::body::face::closest_on_face;
use crate::body::surface::Body;
use crate::body::tree::Closest;
use looks::Looks;

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

/// A body's surface, and which way its parts look.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface<'a> {
    pub body: &'a Body,
    pub looks: &'a Looks,
}

impl Surface<'_> {
    /// Whether anything within a reach of a place may look towards what looks along `facing`: quickly told
    /// where nothing does.
    pub(super) fn may_meet(&self, place: DVec3, facing: DVec3, reach: f64) -> bool {
        (self.looks).any_may(self.body, (place, reach), facing, TOWARDS)
    }

    /// The closest place; `hint` is a triangle that is likely near.
    pub(super) fn closest(&self, place: DVec3, hint: u32) -> Closest {
        self.body.tree().closest(self.body.faces(), place, hint)
    }
}

/// How a place of another body, whose surface looks along `facing` there, is met by a surface, of which
/// the closest place is told; all in the body's frame. Nothing beyond an edge by more than `beside` m, or
/// where both look the same way.
///
/// Half of the mean way to the tangent planes of a triangle's corners is what its curved surface lies
/// beyond it, exact to second order, as contact points do.
pub(super) fn met(
    surface: &Surface<'_>,
    place: DVec3,
    facing: DVec3,
    closest: &Closest,
    beside: f64,
) -> Option<Met> {
    let body = surface.body;
    let (closest, normal, kept) = towards(body, closest, facing)
        .map(|(closest, normal)| (closest, normal, 1.0))
        .or_else(|| around_the_corner(surface, place, facing, closest, beside))?;
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
    surface: &Surface<'_>,
    place: DVec3,
    facing: DVec3,
    nearest: &Closest,
    beside: f64,
) -> Option<(Closest, DVec3, f64)> {
    let outward = surface.body.face(nearest.triangle).normal;
    let is_within = outward.dot(place - nearest.point) < 0.0;
    let around = if is_within { AROUND } else { 1.0 } * beside;
    let other = nearest_towards(surface, place, facing, nearest.distance + around)?;
    let (other, normal) = towards(surface.body, &other, facing)?;
    let left = if is_within {
        (2.0 - 2.0 * (other.distance - nearest.distance) / around).min(1.0)
    } else {
        1.0
    };
    Some((other, normal, left))
}

/// The closest place of the triangles that look towards the other, nearer than `reach` m: of any that
/// near, how far the place is beyond an edge would jump from tick to tick.
fn nearest_towards(
    &Surface { body, looks }: &Surface<'_>,
    place: DVec3,
    facing: DVec3,
    mut reach: f64,
) -> Option<Closest> {
    let mut nearest = None;
    let may = |number| looks.may_look(number, facing, TOWARDS);
    body.tree().visit_within(place, reach, may, |triangle| {
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
    use super::cube::cube;
    use super::*;

    fn met_by(cube: &Body, place: DVec3, beside: f64) -> Option<Met> {
        let looks = Looks::new(cube);
        let closest = cube.tree().closest(cube.faces(), place, 0);
        let surface = Surface {
            body: cube,
            looks: &looks,
        };
        met(&surface, place, DVec3::NEG_Z, &closest, beside)
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
                let met = met_by(&cube, place, beside).expect("near");
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
            let now = met_by(&cube, place, beside).map_or(0.0, |met| met.presence);
            assert!(now <= before + 1e-12 && before - now < 0.03, "{depth}");
            assert!(now > 1.0 - 1e-9 || depth > 0.08, "{depth}");
            before = now;
        }
        assert_eq!(before, 0.0);
    }
}
