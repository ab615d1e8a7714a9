//! Polygons that a line goes through, and the one nearest to a point, by one pass over all of them.
//!
//! For a mesh that changes between any two questions: a tree would take longer to make than it
//! saves.

use std::ops::Range;

use glam::{DVec2, DVec3};

/// Polygons of a mesh as they are drawn: maybe bent, maybe with notches.
#[derive(Debug, Clone, Copy)]
pub struct Polygons<'a> {
    places: &'a [f32],
    corners: &'a [i32],
    starts: &'a [i32],
}

impl<'a> Polygons<'a> {
    /// Coordinates of the vertices one after the other, the vertex of each corner of all polygons,
    /// and each polygon's first corner. None where a corner has no vertex, or the polygons do not
    /// follow each other.
    pub fn new(places: &'a [f32], corners: &'a [i32], starts: &'a [i32]) -> Option<Self> {
        // What is negative is too large as well.
        let vertices = corners.iter().map(|&one| one as u32).max();
        let known = vertices.is_none_or(|last| (last as usize) < places.len() / 3);
        let first = starts.first().is_none_or(|&one| one == 0);
        let last = starts
            .last()
            .is_none_or(|&one| one as usize <= corners.len());
        let fits = known && first && last && starts.is_sorted();
        fits.then_some(Self {
            places,
            corners,
            starts,
        })
    }

    /// Numbers of all polygons that a line goes through, before its origin and behind it. Between
    /// polygons that share an edge no line slips through.
    pub fn on_line(&self, origin: DVec3, along: DVec3) -> Vec<u32> {
        let (right, up) = along.normalize().any_orthonormal_pair();
        // As the line is seen along itself, where it is the origin.
        let flat: Vec<[f32; 2]> = (self.places.chunks_exact(3))
            .map(|place| {
                let away = vector(place) - origin;
                [right.dot(away) as f32, up.dot(away) as f32]
            })
            .collect();
        let around = |corners: &[i32]| {
            let corner = |k: usize| {
                let [x, y] = flat[corners[k] as usize];
                DVec2::new(f64::from(x), f64::from(y))
            };
            surrounds(corners.len(), corner)
        };
        (0..self.starts.len())
            .filter(|&polygon| around(&self.corners[self.range(polygon)]))
            .map(|polygon| polygon as u32)
            .collect()
    }

    /// Number of the polygon nearest to a point; None where there is none.
    pub fn nearest(&self, point: DVec3) -> Option<u32> {
        let mut best = (f64::INFINITY, None);
        let mut corners = Vec::new();
        for polygon in 0..self.starts.len() {
            let numbers = &self.corners[self.range(polygon)];
            let places = numbers.iter().map(|&one| self.place(one));
            let (low, high) = places.clone().fold(
                (DVec3::INFINITY, DVec3::NEG_INFINITY),
                |(low, high), place| (low.min(place), high.max(place)),
            );
            if point.clamp(low, high).distance_squared(point) >= best.0 {
                continue;
            }
            corners.clear();
            corners.extend(places);
            let squared = distance_squared(&corners, point);
            if squared < best.0 {
                best = (squared, Some(polygon as u32));
            }
        }
        best.1
    }

    fn range(&self, polygon: usize) -> Range<usize> {
        let next = self.starts.get(polygon + 1);
        let end = next.map_or(self.corners.len(), |&one| one as usize);
        self.starts[polygon] as usize..end
    }

    fn place(&self, vertex: i32) -> DVec3 {
        vector(&self.places[3 * vertex as usize..])
    }
}

fn vector(coordinates: &[f32]) -> DVec3 {
    DVec3::from(std::array::from_fn(|axis| f64::from(coordinates[axis])))
}

/// Whether a flat polygon has the origin within: whether its border crosses the positive x axis an
/// odd number of times.
fn surrounds(count: usize, corner: impl Fn(usize) -> DVec2) -> bool {
    let mut inside = false;
    let mut before = if count > 0 {
        corner(count - 1)
    } else {
        DVec2::ZERO
    };
    for k in 0..count {
        let here = corner(k);
        if (before.y > 0.0) != (here.y > 0.0) {
            // The same number for both polygons at an edge.
            let (low, high) = if before.y < here.y {
                (before, here)
            } else {
                (here, before)
            };
            inside ^= low.perp_dot(high) > 0.0;
        }
        before = here;
    }
    inside
}

/// Of a point to a polygon: to its edges, and to its mean plane where it is over that.
fn distance_squared(corners: &[DVec3], point: DVec3) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let edges = corners.iter().zip(next);
    let mut nearest = f64::INFINITY;
    let mut normal = DVec3::ZERO;
    for (&start, &end) in edges {
        let (along, away) = (end - start, point - start);
        let length = along.length_squared();
        let share = if length > 0.0 {
            (along.dot(away) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        nearest = nearest.min(away.distance_squared(share * along));
        normal += (start - point).cross(end - point);
    }
    let Some(normal) = normal.try_normalize() else {
        return nearest;
    };
    let (right, up) = normal.any_orthonormal_pair();
    let flat = |k: usize| {
        let away = corners[k] - point;
        DVec2::new(right.dot(away), up.dot(away))
    };
    if surrounds(corners.len(), flat) {
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        nearest = nearest.min(normal.dot(middle - point).powi(2));
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step: a square, a notched pentagon beside it, and a wall up from its far edge.
    const PLACES: &[f32] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [3.0, 0.0, 0.0],
        [3.0, 1.0, 0.0],
        [2.0, 0.2, 0.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ]
    .as_flattened();
    const CORNERS: [i32; 13] = [0, 1, 2, 3, 1, 4, 5, 6, 2, 3, 2, 7, 8];
    const STARTS: [i32; 3] = [0, 4, 9];

    fn step() -> Polygons<'static> {
        Polygons::new(PLACES, &CORNERS, &STARTS).unwrap()
    }

    #[test]
    fn a_line_finds_what_it_goes_through_and_no_notch() {
        let down = DVec3::NEG_Z;
        assert_eq!(step().on_line(DVec3::new(0.4, 0.4, 5.0), down), [0]);
        assert_eq!(step().on_line(DVec3::new(2.0, 0.1, -5.0), down), [1]);
        assert!(step().on_line(DVec3::new(2.0, 0.6, 5.0), down).is_empty());
        let forth = DVec3::new(0.0, 1.0, -1.0);
        assert_eq!(step().on_line(DVec3::new(0.5, 0.0, 0.4), forth), [0]);
        assert_eq!(step().on_line(DVec3::new(0.5, 0.0, 1.5), forth), [2]);
    }

    #[test]
    fn no_line_slips_through_a_shared_edge() {
        for k in 0..1000 {
            let y = 0.001 * f64::from(k) + 1e-4;
            let found = step().on_line(DVec3::new(1.0, y, 3.0), DVec3::NEG_Z);
            assert_eq!(found.len(), 1, "at {y}");
        }
    }

    #[test]
    fn the_nearest_is_by_the_true_border() {
        assert_eq!(step().nearest(DVec3::new(0.5, 0.5, 0.1)), Some(0));
        assert_eq!(step().nearest(DVec3::new(0.5, 0.9, 0.7)), Some(2));
        // Over the notch, the wall's edge is nearer than a plane without one would be.
        assert_eq!(step().nearest(DVec3::new(1.1, 1.0, 0.6)), Some(2));
        assert_eq!(step().nearest(DVec3::new(9.0, 0.0, 0.0)), Some(1));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(Polygons::new(&PLACES[..24], &CORNERS, &STARTS).is_none());
        assert!(Polygons::new(PLACES, &[0, 1, -1], &[0]).is_none());
        assert!(Polygons::new(PLACES, &CORNERS, &[0, 9, 4]).is_none());
        assert!(Polygons::new(PLACES, &CORNERS, &[0, 14]).is_none());
        assert!(Polygons::new(PLACES, &CORNERS, &[1, 4]).is_none());
        let none = Polygons::new(&[], &[], &[]).unwrap();
        assert_eq!(none.nearest(DVec3::ZERO), None);
        assert!(none.on_line(DVec3::ZERO, DVec3::X).is_empty());
    }
}
