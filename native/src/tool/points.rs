//! Where a body can be touched by a tool: points fixed on its surface.
//!
//! Readable reference: `core/contact/near_field/contact_points.py`.

pub mod touchable;
pub(crate) mod tree;

use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::body::surface::{Body, BodyError};
use crate::tool::near_field::NearField;
use crate::tool::points::tree::PointTree;

/// Points within this many times the median distance to the nearest are neighbours.
const NEIGHBOURHOOD: f64 = 2.0;
/// Neighbours of one point, at most.
const MOST_NEIGHBOURS: usize = 24;

/// A place on the surface.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// At rest, m.
    pub position: DVec3,
    /// Unit outward normal of the body there.
    pub normal: DVec3,
    /// Corners of the triangle that it lies in.
    pub nodes: [u32; 3],
    /// Area coordinates there.
    pub alpha: [f64; 3],
    /// Its share of the surface, m^2.
    pub area: f64,
}

impl Point {
    /// The mean of something of the corners of its triangle, weighted with its area coordinates.
    #[inline]
    pub(crate) fn mean(&self, mut of_node: impl FnMut(u32) -> DMat3) -> DMat3 {
        let mut sum = DMat3::ZERO;
        for (&node, &weight) in self.nodes.iter().zip(&self.alpha) {
            if weight != 0.0 {
                sum += of_node(node) * weight;
            }
        }
        sum
    }
}

/// The contact points of a body.
#[derive(Debug)]
pub struct ToolSurface {
    body: Arc<Body>,
    points: Vec<Point>,
    near: Option<NearField>,
    tree: PointTree,
    spacing: f64,
    fingerprint: u64,
    first_neighbour: Vec<u32>,
    neighbours: Vec<u32>,
}

impl ToolSurface {
    /// Checks that the points lie on the body, and finds their neighbours.
    ///
    /// # Errors
    /// [`BodyError`] for a body that does not keep its whole compliance, no points, numbers that are
    /// not finite, places beyond the arrays.
    pub fn new(
        body: Arc<Body>,
        points: Vec<Point>,
        near: Option<NearField>,
    ) -> Result<Self, BodyError> {
        check(&body, &points, near.as_ref())?;
        let positions: Vec<DVec3> = points.iter().map(|p| p.position).collect();
        let tree = PointTree::new(&positions);
        let spacing = median_distance(&tree, &points, body.size());
        let fingerprint = fingerprint(&points, near.as_ref());
        let mut surface = Self {
            body,
            points,
            near,
            tree,
            spacing,
            fingerprint,
            first_neighbour: vec![0],
            neighbours: Vec::new(),
        };
        surface.find_neighbours();
        Ok(surface)
    }

    /// The body that the points lie on.
    #[inline]
    pub fn body(&self) -> &Arc<Body> {
        &self.body
    }

    /// All contact points.
    #[inline]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Whether another one has the same points, with the same near field, on the same body.
    #[inline]
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.body, &other.body)
            && (self.points.len(), self.fingerprint) == (other.points.len(), other.fingerprint)
    }

    /// How far points usually are apart, m.
    #[inline]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    #[inline]
    pub(crate) fn tree(&self) -> &PointTree {
        &self.tree
    }

    /// Points around a point.
    #[inline]
    pub(crate) fn neighbours(&self, point: u32) -> &[u32] {
        let [first, end] = [0, 1].map(|k| self.first_neighbour[point as usize + k] as usize);
        &self.neighbours[first..end]
    }

    /// How far around a point all that looks less than 90 degrees aside from it is among its neighbours, m.
    #[inline]
    pub(crate) fn known_around(&self, point: u32) -> f64 {
        match *self.neighbours(point) {
            [.., last] if self.neighbours(point).len() == MOST_NEIGHBOURS => {
                let [last, own] = [last, point].map(|i| self.points[i as usize].position);
                last.distance(own)
            }
            _ => NEIGHBOURHOOD * self.spacing,
        }
    }

    /// What the mesh is too coarse for, if that is known.
    #[inline]
    pub(crate) fn near(&self) -> Option<&NearField> {
        self.near.as_ref()
    }

    fn find_neighbours(&mut self) {
        let reach = NEIGHBOURHOOD * self.spacing;
        let mut near: Vec<(f64, u32)> = Vec::new();
        for (i, point) in self.points.iter().enumerate() {
            near.clear();
            let within = |middle: DVec3, radius| middle.distance(point.position) <= reach + radius;
            self.tree.visit(within, |j| {
                let other = &self.points[j as usize];
                let distance = other.position.distance(point.position);
                let faces = other.normal.dot(point.normal) > 0.0;
                if j as usize != i && distance <= reach && faces {
                    near.push((distance, j));
                }
            });
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            near.truncate(MOST_NEIGHBOURS);
            self.neighbours.extend(near.iter().map(|&(_, j)| j));
            self.first_neighbour.push(self.neighbours.len() as u32);
        }
    }
}

fn check(body: &Body, points: &[Point], near: Option<&NearField>) -> Result<(), BodyError> {
    let refuse = |reason: String| Err(BodyError(reason));
    if !body.is_whole() {
        return refuse(
            "the body does not keep its whole compliance, without which a tool cannot touch it; \
             make it with whole=True"
                .into(),
        );
    }
    if points.is_empty() {
        return refuse("there are no contact points; give at least one".into());
    }
    if points.len() > (u32::MAX / 4) as usize {
        return refuse("there are too many contact points; give a larger spacing".into());
    }
    for (i, point) in points.iter().enumerate() {
        if (point.nodes.iter()).any(|&node| node as usize >= body.nodes.len()) {
            return refuse(format!(
                "contact point {i} is on a node beyond the {} of the body; give the body's own",
                body.nodes.len()
            ));
        }
        let numbers = point.position.is_finite()
            && point.normal.is_finite()
            && point.alpha.iter().all(|a| a.is_finite());
        if !(numbers && point.area > 0.0 && point.area.is_finite()) {
            return refuse(format!(
                "contact point {i} at {}, normal {}, area {}: all must be finite and the area more than zero",
                point.position, point.normal, point.area
            ));
        }
    }
    let Some(near) = near else { return Ok(()) };
    if near.nodes.len() != body.nodes.len() || near.points.len() != points.len() {
        return refuse(format!(
            "the near field is of {} nodes and {} contact points, the body and the tool of {} and {}; \
             make it for these",
            near.nodes.len(),
            near.points.len(),
            body.nodes.len(),
            points.len()
        ));
    }
    if !near.is_sound() {
        return refuse(
            "the near field has numbers that are not finite or cannot be; give what native_tool gives"
                .into(),
        );
    }
    Ok(())
}

/// A number that nearly always differs where points or what is known about them differ.
fn fingerprint(points: &[Point], near: Option<&NearField>) -> u64 {
    let mut hasher = DefaultHasher::new();
    for point in points {
        for number in point.position.to_array().into_iter().chain(point.alpha) {
            hasher.write_u64(number.to_bits());
        }
    }
    for field in near.iter().flat_map(|near| &near.points) {
        hasher.write_u64(field.own.x_axis.x.to_bits());
    }
    for way in near.iter().flat_map(|near| &near.lifts) {
        hasher.write_u64(way.x.to_bits());
    }
    hasher.finish()
}

/// The median distance of points to their nearest on the same side.
fn median_distance(tree: &PointTree, points: &[Point], size: f64) -> f64 {
    let mut distances: Vec<f64> = (points.iter().enumerate())
        .step_by(points.len().div_ceil(500))
        .map(|(i, point)| {
            let mut reach = 1e-3 * size;
            loop {
                let mut nearest = f64::INFINITY;
                let within =
                    |middle: DVec3, radius| middle.distance(point.position) <= reach + radius;
                tree.visit(within, |j| {
                    let other = &points[j as usize];
                    if j as usize != i && other.normal.dot(point.normal) > 0.0 {
                        nearest = nearest.min(other.position.distance(point.position));
                    }
                });
                if nearest <= reach || reach > 2.0 * size {
                    return nearest.min(size);
                }
                reach *= 2.0;
            }
        })
        .collect();
    distances.sort_by(f64::total_cmp);
    distances[distances.len() / 2]
}
