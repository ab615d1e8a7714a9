//! Triangles among which the closest one to a place is, while that goes no farther than a little way.

use glam::DVec3;

use crate::body::face::closest_on_face;
use crate::body::surface::Body;
use crate::body::tree::Closest;

/// Triangles that are known at most.
const MOST: usize = 12;
/// They are looked for where a place went no farther, by this share of the way, since it was last asked
/// about: what moves faster has left them as soon as they are found.
const SLOW: f64 = 0.25;

/// What is known around a place.
#[derive(Debug, Clone, Copy)]
pub(in crate::pile) struct Known {
    place: DVec3,
    /// Of these there are none where nothing is known.
    count: usize,
    triangles: [u32; MOST],
    last: DVec3,
}

impl Known {
    /// Nothing yet.
    pub const NOTHING: Self = Self {
        place: DVec3::INFINITY,
        count: 0,
        triangles: [0; MOST],
        last: DVec3::INFINITY,
    };

    /// The closest place of a body's surface; `hint` is a triangle that is likely near. What is known is
    /// good for a way of so many m.
    pub fn closest(&mut self, body: &Body, place: DVec3, hint: u32, way: f64) -> Closest {
        let before = std::mem::replace(&mut self.last, place);
        if self.count > 0 && self.place.distance(place) <= way {
            return self.among_known(body, place, hint);
        }
        let closest = body.tree().closest(body.faces(), place, hint);
        self.count = 0;
        if before.distance(place) <= SLOW * way {
            self.learn(body, place, closest.distance + 2.0 * way);
        }
        closest
    }

    fn among_known(&self, body: &Body, place: DVec3, hint: u32) -> Closest {
        let of = |triangle: u32| {
            let (alpha, point) = closest_on_face(body.face(triangle), place);
            Closest {
                triangle,
                alpha,
                point,
                // Its square until the last is known.
                distance: point.distance_squared(place),
            }
        };
        let known = self.triangles[..self.count].iter();
        let others = known.filter(|&&triangle| triangle != hint);
        let mut closest = others.fold(of(hint), |closest, &triangle| {
            let other = of(triangle);
            if other.distance < closest.distance {
                other
            } else {
                closest
            }
        });
        closest.distance = closest.distance.sqrt();
        closest
    }

    /// Any triangle that is the closest within a way from a place is there no farther than the closest one
    /// and twice that way.
    fn learn(&mut self, body: &Body, place: DVec3, reach: f64) {
        let (mut count, triangles) = (0, &mut self.triangles);
        let any = |_| true;
        body.tree().visit_within(place, reach, any, |triangle| {
            let (_, point) = closest_on_face(body.face(triangle), place);
            if point.distance(place) <= reach {
                if let Some(known) = triangles.get_mut(count) {
                    *known = triangle;
                }
                count += 1;
            }
            reach
        });
        // Where there are more, they are not all known.
        self.count = if count <= MOST { count } else { 0 };
        self.place = place;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pile::outline::cube::cube;

    /// Along a way over faces, edges and corners, within and without.
    #[test]
    fn the_closest_place_is_the_same_as_among_all() {
        let (cube, way) = (cube(), 0.02);
        let (mut known, mut hint, mut were_known) = (Known::NOTHING, 0, 0);
        for step in 0..20_000 {
            let t = 1e-3 * f64::from(step);
            let place = DVec3::new((1.1 * t).sin(), (0.7 * t).cos(), (1.3 * t).sin()) * 0.6;
            let among_all = cube.tree().closest(cube.faces(), place, 0);
            were_known += usize::from(known.count > 0);
            let found = known.closest(&cube, place, hint, way);
            assert!((found.distance - among_all.distance).abs() < 1e-15);
            assert!(found.point.distance(among_all.point) < 1e-12 || among_all.distance > 0.1);
            hint = found.triangle;
        }
        assert!(were_known > 10_000, "{were_known}");
    }
}
