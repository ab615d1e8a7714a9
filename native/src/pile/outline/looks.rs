//! Which way the triangles in each box of a body's tree look.

use glam::DVec3;

use crate::body::surface::Body;

/// Normals of a triangle that differ by more than this cosine may look anywhere between its corners.
const ALIKE: f64 = 0.2;

/// Least and greatest coordinates of the normals in each box: of triangles, and of the curved surface that
/// they stand for.
#[derive(Debug, Clone)]
pub(in crate::pile) struct Looks {
    boxes: Vec<[DVec3; 2]>,
}

impl Looks {
    /// Of a body.
    pub fn new(body: &Body) -> Self {
        let mut boxes = Vec::new();
        let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let join = |a: [DVec3; 2], b: [DVec3; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let of = |triangle| of_triangle(body, triangle);
        body.tree().gather(&mut boxes, none, of, join);
        Self { boxes }
    }

    /// Whether in a box, by number, anything may look at less than a cosine along a direction.
    #[inline]
    pub fn may_look(&self, number: usize, along: DVec3, cosine: f64) -> bool {
        let [low, high] = self.boxes[number];
        (low * along).min(high * along).element_sum() < cosine
    }

    /// Whether within a reach of a place anything may look at less than a cosine along a direction.
    pub fn any_may(
        &self,
        body: &Body,
        (place, reach): (DVec3, f64),
        along: DVec3,
        cosine: f64,
    ) -> bool {
        let mut any = false;
        let may = |number| self.may_look(number, along, cosine);
        // As soon as one may, no more are visited but around the place itself.
        (body.tree()).visit_within(place, reach, may, |_| {
            any = true;
            0.0
        });
        any
    }
}

/// Between the corners a normal is the mean of theirs, made as long as one again: longer by as much as the
/// shortest of the means is short, at most.
fn of_triangle(body: &Body, triangle: u32) -> [DVec3; 2] {
    let (flat, corners) = (body.face(triangle).normal, body.corner_normals(triangle));
    let mean = corners.iter().sum::<DVec3>().normalize_or_zero();
    let alike = (corners.iter()).fold(1.0_f64, |least, corner| least.min(corner.dot(mean)));
    if alike < ALIKE {
        return [DVec3::NEG_ONE, DVec3::ONE];
    }
    let all = corners.iter().flat_map(|&corner| [corner, corner / alike]);
    all.fold([flat, flat], |[low, high], normal| {
        [low.min(normal), high.max(normal)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pile::outline::cube::cube;

    #[test]
    fn beneath_the_top_of_a_cube_all_looks_up() {
        let cube = cube();
        let looks = Looks::new(&cube);
        let beneath = (DVec3::new(0.0, 0.0, 0.45), 0.2);
        assert!(looks.any_may(&cube, beneath, DVec3::NEG_Z, -0.3));
        for along in [DVec3::Z, DVec3::X, DVec3::NEG_Y] {
            assert!(!looks.any_may(&cube, beneath, along, -0.3));
        }
        let beside_the_edge = (DVec3::new(0.45, 0.0, 0.45), 0.2);
        assert!(looks.any_may(&cube, beside_the_edge, DVec3::NEG_X, -0.3));
    }
}
