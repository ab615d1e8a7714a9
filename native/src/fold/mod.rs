//! Where the moved surface of a body is within the body itself: an ear within a head.
//!
//! A node is within where it lies right beneath a triangle that faces it and did not at rest, as the
//! front of an ear lies beneath its back, and where what is just outside of it is within the body.

mod turned;

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::body::face::Face;
use crate::body::surface::Body;
use crate::body::sweep::Feature;
use crate::body::tree::Tree;

/// A triangle faces a node if their normals turn away from each other by more than this cosine.
const FACING: f64 = -0.2;
/// A node is right beneath a triangle if it lies aside of its nearest place by this share of its depth
/// at most.
const ASIDE: f64 = 0.7;
/// And was so at rest if it lay aside by this share.
const ASIDE_AT_REST: f64 = 1.5;

/// Nodes that have moved by less than this share of the farthest are not looked at: where surfaces
/// meet, nodes of the one that moves are within the other.
const MOVES: f64 = 0.2;

/// A node of the surface within the body.
#[derive(Debug, Clone, Copy)]
pub struct Fold {
    /// By number.
    pub node: u32,
    /// Triangle over it.
    pub triangle: u32,
    /// Area coordinates there.
    pub alpha: [f64; 3],
    /// Out of the body there.
    pub normal: DVec3,
    /// Beneath it, m.
    pub depth: f64,
}

/// The surface of a body, moved; keeps its memory.
#[derive(Debug, Clone)]
pub struct Moved {
    body: Arc<Body>,
    faces: Vec<Face>,
    tree: Tree,
    normals: Vec<DVec3>,
    /// Around the normals of the triangles in each box of the tree: most boxes hold none that faces
    /// a node.
    facings: Vec<Cube>,
}

/// Least and largest coordinates.
type Cube = [DVec3; 2];
const EMPTY: Cube = [DVec3::INFINITY, DVec3::NEG_INFINITY];

/// Least product of a vector with what is in a cube.
fn least_along(v: DVec3, [low, high]: Cube) -> f64 {
    (v * low).min(v * high).element_sum()
}

impl Moved {
    /// The surface at rest.
    pub fn new(body: Arc<Body>) -> Self {
        Self {
            faces: body.faces().to_vec(),
            tree: body.tree().clone(),
            normals: vec![DVec3::ZERO; body.nodes.len()],
            facings: Vec::new(),
            body,
        }
    }

    /// Of the surface.
    pub fn node_count(&self) -> usize {
        self.normals.len()
    }

    /// Nodes within the body by `deepest` m at most, where all nodes are moved to `places`.
    pub fn folds(&mut self, places: &[DVec3], deepest: f64) -> Vec<Fold> {
        self.move_to(places);
        let gone = |node: usize| places[node].distance_squared(self.body.nodes[node]);
        let farthest = (0..places.len()).map(gone).fold(0.0, f64::max);
        let moves = |&node: &usize| gone(node) >= MOVES * MOVES * farthest && farthest > 0.0;
        (0..places.len())
            .filter(moves)
            .filter_map(|node| self.fold(node as u32, places[node], deepest))
            .collect()
    }

    /// How the surface is turned at each node, where all nodes are moved to `places`.
    pub fn turns(&self, places: &[DVec3]) -> Vec<DMat3> {
        turned::turns(&self.body.nodes, places, &self.body.triangles)
    }

    fn move_to(&mut self, places: &[DVec3]) {
        self.normals.fill(DVec3::ZERO);
        for (face, nodes) in self.faces.iter_mut().zip(&self.body.triangles) {
            face.corners = nodes.map(|node| places[node as usize]);
            let [a, b, c] = face.corners;
            face.area_vector = (b - a).cross(c - a);
            face.normal = face.area_vector.normalize_or_zero();
            for &node in nodes {
                self.normals[node as usize] += face.area_vector;
            }
        }
        for normal in &mut self.normals {
            *normal = normal.normalize_or_zero();
        }
        self.tree.refit(&self.faces);
        self.tree.gather(
            &mut self.facings,
            EMPTY,
            |triangle| [self.faces[triangle as usize].normal; 2],
            |[low, high], [lower, higher]| [low.min(lower), high.max(higher)],
        );
    }

    fn fold(&self, node: u32, place: DVec3, deepest: f64) -> Option<Fold> {
        // Most nodes are not, which is told sooner than what is over one.
        if !self.is_within(node, place) {
            return None;
        }
        let normal = self.normals[node as usize];
        let (mut best, mut reach) = (None, deepest);
        let faces_it = |part: usize| least_along(normal, self.facings[part]) <= FACING;
        self.tree.visit_within(place, reach, faces_it, |triangle| {
            let face = &self.faces[triangle as usize];
            // No place of the triangle is nearer than its plane.
            let beneath = face.normal.dot(face.corners[0] - place);
            if face.normal.dot(normal) > FACING || beneath <= 0.0 || beneath >= reach {
                return reach;
            }
            let (alpha, point) = crate::body::face::closest_on_face(face, place);
            let way = point - place;
            let depth = way.dot(face.normal);
            let distance = way.length();
            let is_beneath = (way - face.normal * depth).length() <= ASIDE * depth;
            if distance < reach && is_beneath && self.meets(node, triangle, alpha) {
                reach = distance;
                best = Some(Fold {
                    node,
                    triangle,
                    alpha,
                    normal: face.normal,
                    depth,
                });
            }
            reach
        });
        best
    }

    /// Whether a node may meet a place: it is no corner of the triangle, and was not beneath that at
    /// rest already.
    fn meets(&self, node: u32, triangle: u32, alpha: [f64; 3]) -> bool {
        if self.body.triangles[triangle as usize].contains(&node) {
            return false;
        }
        let face = self.body.face(triangle);
        let way = face.at(alpha) - self.body.nodes[node as usize];
        let depth = way.dot(face.normal);
        depth <= 0.0 || (way - face.normal * depth).length() > ASIDE_AT_REST * depth
    }

    /// Whether what is just outside of a node is within the body: the way out from there leaves it
    /// before it enters it.
    fn is_within(&self, node: u32, place: DVec3) -> bool {
        let end = place + self.normals[node as usize] * (2.0 * self.body.size());
        let surface = (&self.faces[..], &self.body.triangles[..]);
        let own = [Feature::new(&[node])];
        let met = self.tree.sweep_faces(surface, place, end, &own);
        let enters = met
            .entering
            .map_or(f64::INFINITY, |crossing| crossing.fraction);
        met.leaving
            .is_some_and(|crossing| crossing.fraction < enters)
    }
}
