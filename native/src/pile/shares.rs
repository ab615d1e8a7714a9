//! How a force between contact points is shared out among those around it.
//!
//! Shares are those of a moving least squares fit (P. Lancaster and K. Salkauskas, 1981): they come and
//! go without a jump, sum up to one, and carry the force at its own place, so that no torque is made.

use glam::{DMat3, DVec3};

use super::contact::{MOST_SHARES, Shares};
use crate::tool::points::ToolSurface;

/// A force is shared by points within so many distances to the third nearest.
const REACH: f64 = 1.4;
/// Points that look more than 60 degrees aside carry nothing.
const FACING: f64 = 0.5;
/// Its neighbours do where the normal is less than 30 degrees aside from that of a point: at most 60 and
/// these are 90, as far as neighbours of a point look aside.
const LIKE_THE_HINT: f64 = 0.867;
/// First search for points within so many usual distances between them.
const FIRST_SEARCH: f64 = 1.5;
/// Where points lie on a line, across it this share of their own extent holds the fit.
const LEAST_EXTENT: f64 = 1e-6;

/// Contact points that carry a force at a place on the surface, where `normal` is outward, and their
/// shares; `hint` is one that is likely near.
pub(super) fn shares(
    surface: &ToolSurface,
    place: DVec3,
    normal: DVec3,
    hint: Option<u32>,
) -> Shares {
    let near = hint
        .and_then(|hint| nearest_around(surface, place, normal, hint))
        .unwrap_or_else(|| nearest(surface, place, normal));
    let (near, mut found) = (near.points(), Shares::NONE);
    let Some(&(third, _)) = near.get(2).or(near.last()) else {
        return found;
    };
    // Where there are more than carry anything, the first that does not has no share.
    let last = near
        .get(MOST_SHARES)
        .map_or(f64::INFINITY, |&(last, _)| last);
    let reach = (REACH * third).min(last).max(f64::MIN_POSITIVE);
    let (first, second) = normal.any_orthonormal_pair();
    // 1, and the way from the place along the surface, as shares of the reach.
    let basis = |point: u32| {
        let way = (surface.points()[point as usize].position - place) / reach;
        DVec3::new(1.0, way.dot(first), way.dot(second))
    };
    let mut moments = DMat3::ZERO;
    for &(distance, point) in near {
        let inside = 1.0 - (distance / reach).powi(2);
        if inside > 0.0 {
            let (own, weight) = (basis(point), inside * inside);
            moments += outer(own, own * weight);
            found.push(point, weight);
        }
    }
    let extent = moments.y_axis.y + moments.z_axis.z;
    let held = (LEAST_EXTENT * extent).max(f64::MIN_POSITIVE);
    moments += DMat3::from_diagonal(DVec3::new(0.0, held, held));
    let fit = moments.inverse() * DVec3::X;
    let mut shares = Shares::NONE;
    if !fit.is_finite() {
        if let Some(&(point, _)) = found.first() {
            shares.push(point, 1.0);
        }
        return shares;
    }
    for &(point, weight) in found.iter() {
        shares.push(point, weight * fit.dot(basis(point)));
    }
    shares
}

/// The points nearest to a place, nearest first: one more than may carry its force.
struct Nearest {
    count: usize,
    points: [(f64, u32); MOST_SHARES + 1],
}

impl Nearest {
    const NONE: Self = Self {
        count: 0,
        points: [(0.0, 0); MOST_SHARES + 1],
    };

    fn points(&self) -> &[(f64, u32)] {
        &self.points[..self.count]
    }

    /// Takes a point in that is within a reach of a place and looks as it does.
    #[inline]
    fn offer_if(
        &mut self,
        surface: &ToolSurface,
        place: DVec3,
        normal: DVec3,
        (number, reach): (u32, f64),
    ) {
        let point = &surface.points()[number as usize];
        let distance = point.position.distance(place);
        if distance <= reach && point.normal.dot(normal) > FACING {
            self.offer(distance, number);
        }
    }

    fn offer(&mut self, distance: f64, point: u32) {
        let place = (self.points()).partition_point(|&other| other <= (distance, point));
        if place < self.points.len() {
            self.count = (self.count + 1).min(self.points.len());
            self.points[place..self.count].rotate_right(1);
            self.points[place] = (distance, point);
        }
    }
}

/// Of a point's neighbours those around a place that look as it does, if certainly all that carry
/// anything are among them.
fn nearest_around(
    surface: &ToolSurface,
    place: DVec3,
    normal: DVec3,
    hint: u32,
) -> Option<Nearest> {
    let point = &surface.points()[hint as usize];
    // What looks as the place does looks less than 90 degrees aside from the point, as neighbours do.
    if point.normal.dot(normal) < LIKE_THE_HINT {
        return None;
    }
    let beside = point.position.distance(place);
    let known = surface.known_around(hint) - beside;
    let mut found = Nearest::NONE;
    let neighbours = surface.neighbours(hint).iter();
    for &number in neighbours.chain([&hint]) {
        found.offer_if(surface, place, normal, (number, known));
    }
    let third = found.points().get(2)?.0;
    (REACH * third < known).then_some(found)
}

/// Points around a place that look as it does: three at least, if there are.
fn nearest(surface: &ToolSurface, place: DVec3, normal: DVec3) -> Nearest {
    let mut reach = FIRST_SEARCH * surface.spacing();
    let most = 2.0 * surface.body().size();
    loop {
        let mut found = Nearest::NONE;
        let within = |middle: DVec3, radius| middle.distance(place) <= reach + radius;
        surface.tree().visit(within, |number| {
            found.offer_if(surface, place, normal, (number, reach));
        });
        let third = found.points().get(2);
        let is_enough = third.is_some_and(|third| REACH * third.0 <= reach);
        if is_enough || reach > most {
            return found;
        }
        reach *= 2.0;
    }
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_are_kept_in_their_order() {
        let mut nearest = Nearest::NONE;
        for number in 0..40_u32 {
            nearest.offer(f64::from(number * 17 % 40), number);
        }
        let kept: Vec<f64> = nearest.points().iter().map(|near| near.0).collect();
        let wanted: Vec<f64> = (0..=MOST_SHARES as u32).map(f64::from).collect();
        assert_eq!(kept, wanted);
    }

    #[test]
    fn an_outer_product_is_one() {
        let (a, b) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 4.0));
        let x = DVec3::new(0.3, -0.2, 0.7);
        assert!((outer(a, b) * x).distance(a * b.dot(x)) < 1e-12);
    }
}
