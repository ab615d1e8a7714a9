//! How a force between contact points is shared out among those around it.
//!
//! Shares are those of a moving least squares fit (P. Lancaster and K. Salkauskas, 1981): they come and
//! go without a jump, sum up to one, and carry the force at its own place, so that no torque is made.

use glam::{DMat3, DVec3};

use crate::tool::points::ToolSurface;

/// A force is shared by points within so many distances to the third nearest.
const REACH: f64 = 1.4;
/// Points that look more than 60 degrees aside carry nothing.
const FACING: f64 = 0.5;
/// First search for points within so many usual distances between them.
const FIRST_SEARCH: f64 = 1.5;
/// Where points lie on a line, across it this share of their own extent holds the fit.
const LEAST_EXTENT: f64 = 1e-6;

/// Contact points that carry a force at a place on the surface, where `normal` is outward, and their
/// shares.
pub(super) fn shares(surface: &ToolSurface, place: DVec3, normal: DVec3) -> Vec<(u32, f64)> {
    let near = nearest(surface, place, normal);
    let Some(&(third, _)) = near.get(2).or(near.last()) else {
        return Vec::new();
    };
    let reach = REACH * third.max(f64::MIN_POSITIVE);
    let (first, second) = normal.any_orthonormal_pair();
    // 1, and the way from the place along the surface, as shares of the reach.
    let basis = |point: u32| {
        let way = (surface.points()[point as usize].position - place) / reach;
        DVec3::new(1.0, way.dot(first), way.dot(second))
    };
    let weighted = |&(distance, point): &(f64, u32)| {
        let inside = 1.0 - (distance / reach).powi(2);
        (inside > 0.0).then_some((point, inside * inside))
    };
    let near: Vec<(u32, f64)> = near.iter().filter_map(weighted).collect();
    let mut moments = DMat3::ZERO;
    for &(point, weight) in &near {
        let own = basis(point);
        moments += outer(own, own * weight);
    }
    let extent = moments.y_axis.y + moments.z_axis.z;
    let held = (LEAST_EXTENT * extent).max(f64::MIN_POSITIVE);
    moments += DMat3::from_diagonal(DVec3::new(0.0, held, held));
    let fit = moments.inverse() * DVec3::X;
    if !fit.is_finite() {
        return near
            .first()
            .map(|&(point, _)| (point, 1.0))
            .into_iter()
            .collect();
    }
    near.iter()
        .map(|&(point, weight)| (point, weight * fit.dot(basis(point))))
        .collect()
}

/// Points around a place that look as it does, nearest first: three at least, if there are.
fn nearest(surface: &ToolSurface, place: DVec3, normal: DVec3) -> Vec<(f64, u32)> {
    let mut reach = FIRST_SEARCH * surface.spacing();
    let most = 2.0 * surface.body().size();
    loop {
        let mut found = Vec::new();
        let within = |middle: DVec3, radius| middle.distance(place) <= reach + radius;
        surface.tree().visit(within, |number| {
            let point = &surface.points()[number as usize];
            let distance = point.position.distance(place);
            if distance <= reach && point.normal.dot(normal) > FACING {
                found.push((distance, number));
            }
        });
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let is_enough = found.get(2).is_some_and(|third| REACH * third.0 <= reach);
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
    fn an_outer_product_is_one() {
        let (a, b) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 4.0));
        let x = DVec3::new(0.3, -0.2, 0.7);
        assert!((outer(a, b) * x).distance(a * b.dot(x)) < 1e-12);
    }
}
