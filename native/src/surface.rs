//! The rest surface: geometry, neighbours across the free side, corner fans, pseudonormals.
//!
//! All of it is immutable after [`Body::new`], so the servo thread and tests share one `Arc`.

use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::compliance::Compliance;
use crate::felt::Softenings;
use crate::joining::{edge_nodes, edges_by_nodes, gather_fans, join_edges};
use crate::normals::{is_soft, set_fan_normals};
use crate::tree::Tree;
use crate::whole::Whole;

/// Why a surface cannot be touched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BodyError(pub String);

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BodyError {}

/// Edge `k` of a triangle runs from its corner `k` to its corner `(k + 1) % 3`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HalfEdge {
    /// Triangle the half-edge belongs to.
    pub triangle: u32,
    /// Which of its three edges.
    pub edge: u8,
}

/// A triangle with what every tick needs of it, in one place in memory.
#[derive(Debug, Clone)]
pub struct Face {
    /// Corner positions, counter-clockwise seen from outside.
    pub corners: [DVec3; 3],
    /// Twice the area times the outward normal.
    pub area_vector: DVec3,
    /// Unit outward normal.
    pub normal: DVec3,
    /// Unit in-plane perpendicular of each edge, pointing into the triangle.
    pub inward: [DVec3; 3],
    /// The half-edge across each edge, on the other side of the free space there.
    pub across: [HalfEdge; 3],
    /// The fan each corner belongs to.
    pub fans: [u32; 3],
    /// How far rounding may turn `normal`, rad, doubled; large for slivers.
    slack: f64,
}

impl Face {
    /// Area coordinates of the orthogonal projection of `p` on the triangle's plane.
    #[inline]
    pub fn area_coordinates(&self, p: DVec3) -> [f64; 3] {
        let [a, b, c] = self.corners;
        let scale = 1.0 / self.area_vector.length_squared();
        let of = |u: DVec3, v: DVec3| self.area_vector.dot((v - u).cross(p - u)) * scale;
        [of(b, c), of(c, a), of(a, b)]
    }

    /// Position of area coordinates; exact at the corners.
    #[inline]
    pub fn at(&self, alpha: [f64; 3]) -> DVec3 {
        self.corners[0] * alpha[0] + self.corners[1] * alpha[1] + self.corners[2] * alpha[2]
    }

    /// Whether rounding cannot hide that both points are on one side of the plane.
    #[inline]
    pub(crate) fn is_clearly_beside(&self, p: DVec3, q: DVec3) -> bool {
        let (u, v) = (p - self.corners[0], q - self.corners[0]);
        let (a, b) = (self.normal.dot(u), self.normal.dot(v));
        let margin = self.slack * (u.abs().element_sum() + v.abs().element_sum());
        (a > margin && b > margin) || (a < -margin && b < -margin)
    }

    /// Positive outside the plane, negative inside, zero exactly on it: the sign is exact.
    #[inline]
    pub fn side(&self, p: DVec3) -> f64 {
        -orientation(self.corners[0], self.corners[1], self.corners[2], p)
    }
}

/// Shewchuk's adaptive orientation test: its sign is that of the exact determinant.
#[inline]
pub(crate) fn orientation(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |p: DVec3| robust::Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// The triangles around a node on one sheet of the surface.
///
/// A node where the surface touches itself has several fans; they are walked separately.
#[derive(Debug, Clone, Copy)]
pub struct Fan {
    /// The node in the middle.
    pub node: u32,
    pub(crate) first: u32,
    pub(crate) count: u32,
    /// Sum of the face normals weighted with their corner angles.
    pub normal: DVec3,
}

impl Fan {
    #[inline]
    fn of<'a>(&self, fan_corners: &'a [Corner]) -> &'a [Corner] {
        let first = self.first as usize;
        &fan_corners[first..first + self.count as usize]
    }
}

/// One corner of one triangle.
#[derive(Debug, Clone, Copy)]
pub struct Corner {
    /// Triangle number.
    pub triangle: u32,
    /// Which of its corners.
    pub corner: u8,
}

/// The place of a node that is pinned: it never moves.
const PINNED: u32 = u32::MAX;

/// How the surface gives way under forces on the nodes of one triangle.
///
/// Copied from the compliance once: a tick must not wait for pages of a table of hundreds of
/// megabytes, nor end with the file that such a table may lie in.
#[derive(Debug)]
struct Response {
    /// L_aa of each node, the inverse of its contact block where it is pinned.
    own: Vec<DMat3>,
    /// Where each node stands in the compliance.
    places: Vec<u32>,
    /// L_ab of each edge, a < b.
    between: Vec<DMat3>,
    /// For each triangle which of `between` its three edges are.
    edges: Vec<[u32; 3]>,
}

/// A soft body as the servo sees it: rest surface and contact stiffness per node.
#[derive(Debug)]
pub struct Body {
    /// Rest positions, m.
    pub nodes: Vec<DVec3>,
    /// Node numbers per triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// `L_aa^-1` at unit modulus per node, N/m per Pa (9).
    pub contact_blocks: Vec<DMat3>,
    faces: Vec<Face>,
    fans: Vec<Fan>,
    fan_corners: Vec<Corner>,
    edge_normals: Vec<[DVec3; 3]>,
    node_normals: Vec<DVec3>,
    corner_normals: Vec<[DVec3; 3]>,
    tree: Tree,
    size: f64,
    response: Option<Response>,
    whole: Option<Whole>,
    /// How nodes soften under a press, as far as that was told.
    pub softenings: Softenings,
}

impl Body {
    /// Checks the surface and prepares neighbours, normals and the search tree.
    ///
    /// # Errors
    /// [`BodyError`] for numbers that are not finite, indices out of range, triangles without an
    /// area, open edges, or a surface turned inside out.
    pub fn new(
        nodes: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        contact_blocks: Vec<DMat3>,
    ) -> Result<Self, BodyError> {
        check_arrays(&nodes, &triangles, &contact_blocks)?;
        let mut faces = measure_faces(&nodes, &triangles)?;
        check_volume(&faces)?;
        let edges = edges_by_nodes(&triangles);
        let edge_normals = join_edges(&triangles, &mut faces, &edges)?;
        let (fans, fan_corners) = gather_fans(&triangles, &mut faces);
        let mut node_normals = vec![DVec3::ZERO; nodes.len()];
        for fan in &fans {
            node_normals[fan.node as usize] += fan.normal;
        }
        let mut corner_normals = vec![[DVec3::ZERO; 3]; faces.len()];
        for fan in &fans {
            set_fan_normals(&faces, fan.of(&fan_corners), &mut corner_normals);
        }
        let tree = Tree::new(&faces);
        let size = tree.diagonal();
        let softenings = Softenings::unknown(nodes.len());
        Ok(Self {
            nodes,
            triangles,
            contact_blocks,
            faces,
            fans,
            fan_corners,
            edge_normals,
            node_normals,
            corner_normals,
            tree,
            size,
            response: None,
            whole: None,
            softenings,
        })
    }

    /// The same body, which now also knows how its surface moves.
    ///
    /// `free_nodes` are the numbers of the nodes that the compliance counts, in its order; the
    /// others are pinned.
    ///
    /// # Errors
    /// [`BodyError`] when there are not as many as in the compliance, or a number is out of range
    /// or there twice.
    pub fn with_compliance(
        mut self,
        compliance: &Compliance,
        free_nodes: &[u32],
    ) -> Result<Self, BodyError> {
        if free_nodes.len() != compliance.node_count() {
            return Err(BodyError(format!(
                "{} free nodes are named for a compliance of {}",
                free_nodes.len(),
                compliance.node_count()
            )));
        }
        let mut places = vec![PINNED; self.nodes.len()];
        for (place, &node) in free_nodes.iter().enumerate() {
            match places.get_mut(node as usize) {
                Some(free @ &mut PINNED) => *free = place as u32,
                Some(_) => return Err(BodyError(format!("node {node} is named free twice"))),
                None => {
                    return Err(BodyError(format!(
                        "free node {node} is beyond the {} nodes given",
                        self.nodes.len()
                    )));
                }
            }
        }
        self.response = Some(self.gather_response(compliance, places));
        Ok(self)
    }

    /// Reads the blocks of all nodes and edges.
    fn gather_response(&self, compliance: &Compliance, places: Vec<u32>) -> Response {
        let block = |a: u32, b: u32| match (places[a as usize], places[b as usize]) {
            (PINNED, _) | (_, PINNED) if a == b => self.contact_blocks[a as usize].inverse(),
            (PINNED, _) | (_, PINNED) => DMat3::ZERO,
            (a, b) => compliance.block(a as usize, b as usize),
        };
        let mut between = Vec::new();
        let mut numbers = HashMap::new();
        let edges = (self.triangles.iter())
            .map(|triangle| {
                [0, 1, 2].map(|k| {
                    let (a, b) = edge_nodes(triangle, k);
                    let (low, high) = (a.min(b), a.max(b));
                    *numbers.entry((low, high)).or_insert_with(|| {
                        between.push(block(low, high));
                        between.len() as u32 - 1
                    })
                })
            })
            .collect();
        let own = (0..places.len() as u32).map(|node| block(node, node));
        Response {
            own: own.collect(),
            between,
            edges,
            places,
        }
    }

    /// The same body, which also keeps the compliance itself: any two nodes have a block then.
    ///
    /// The tick reads it where it lies, so it must not be a file mapped into memory.
    ///
    /// # Errors
    /// As of [`with_compliance`](Self::with_compliance).
    pub fn with_whole_compliance(
        self,
        compliance: Arc<Compliance>,
        free_nodes: &[u32],
    ) -> Result<Self, BodyError> {
        let mut body = self.with_compliance(&compliance, free_nodes)?;
        body.whole = Some(Whole::new(compliance, free_nodes, body.nodes.len()));
        Ok(body)
    }

    /// Whether any two nodes have a block.
    #[inline]
    pub fn is_whole(&self) -> bool {
        self.whole.is_some()
    }

    /// L_ab at unit modulus for two nodes of the surface; `None` for a body that does not keep its
    /// whole compliance.
    ///
    /// A pinned node gives way to its own force as its contact block says, and to no other.
    #[inline]
    pub fn block(&self, a: u32, b: u32) -> Option<DMat3> {
        let whole = self.whole.as_ref()?;
        Some(whole.block(a, b).unwrap_or_else(|| {
            if a == b {
                self.contact_blocks[a as usize].inverse()
            } else {
                DMat3::ZERO
            }
        }))
    }

    /// Whether the body knows how its surface moves.
    #[inline]
    pub fn has_compliance(&self) -> bool {
        self.response.is_some()
    }

    /// L_ab at unit modulus for two corners of a triangle, zero where one is pinned; `None` for a
    /// body without a compliance.
    #[inline]
    pub fn compliance_block(&self, triangle: u32, a: usize, b: usize) -> Option<DMat3> {
        let response = self.response.as_ref()?;
        let nodes = self.triangles[triangle as usize];
        if a == b {
            let is_pinned = response.places[nodes[a] as usize] == PINNED;
            return Some(if is_pinned {
                DMat3::ZERO
            } else {
                response.own[nodes[a] as usize]
            });
        }
        // Edge k runs from corner k to the next one: the edges without the corners 2, 0, 1.
        let edge = (4 - a - b) % 3;
        let block = response.between[response.edges[triangle as usize][edge] as usize];
        let straight = nodes[a] < nodes[b];
        Some(if straight { block } else { block.transpose() })
    }

    /// L at unit modulus of the three corners of a triangle, a pinned one's from its contact block,
    /// and of its three edges, each between its ends in either order; `None` for a body without a
    /// compliance.
    #[inline]
    pub fn triangle_compliance(&self, triangle: u32) -> Option<[[DMat3; 3]; 2]> {
        let response = self.response.as_ref()?;
        let nodes = self.triangles[triangle as usize];
        let edges = response.edges[triangle as usize];
        Some([
            nodes.map(|node| response.own[node as usize]),
            edges.map(|edge| response.between[edge as usize]),
        ])
    }

    /// All triangles with their geometry.
    #[inline]
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// One triangle with its geometry.
    #[inline]
    pub fn face(&self, triangle: u32) -> &Face {
        &self.faces[triangle as usize]
    }

    /// The fan of triangles around a corner, counter-clockwise.
    #[inline]
    pub fn fan(&self, fan: u32) -> (&Fan, &[Corner]) {
        let fan = &self.fans[fan as usize];
        (fan, fan.of(&self.fan_corners))
    }

    /// The search tree over the triangles.
    #[inline]
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Diagonal of the bounding box, m.
    #[inline]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Sum of the normals of all triangles that meet in an edge.
    #[inline]
    pub fn edge_normal(&self, triangle: u32, edge: usize) -> DVec3 {
        self.edge_normals[triangle as usize][edge]
    }

    /// Unit normals at a triangle's corners, shared with its neighbours across soft edges.
    #[inline]
    pub fn corner_normals(&self, triangle: u32) -> &[DVec3; 3] {
        &self.corner_normals[triangle as usize]
    }

    /// Whether the corner normals on both sides of an edge are meant to be one.
    #[inline]
    pub fn is_soft(&self, edge: HalfEdge) -> bool {
        is_soft(&self.faces, edge)
    }

    /// Angle-weighted normal of a node over all its triangles.
    #[inline]
    pub fn node_normal(&self, node: u32) -> DVec3 {
        self.node_normals[node as usize]
    }
}

fn check_arrays(
    nodes: &[DVec3],
    triangles: &[[u32; 3]],
    contact_blocks: &[DMat3],
) -> Result<(), BodyError> {
    if triangles.is_empty() {
        return Err(BodyError("the body has no triangles".into()));
    }
    if triangles.len() > (u32::MAX / 4) as usize {
        return Err(BodyError("the body has too many triangles".into()));
    }
    if contact_blocks.len() != nodes.len() {
        return Err(BodyError(format!(
            "contact_blocks has {} blocks for {} nodes; one 3 x 3 block a node is needed",
            contact_blocks.len(),
            nodes.len()
        )));
    }
    if let Some(i) = nodes.iter().position(|p| !p.is_finite()) {
        return Err(BodyError(format!(
            "node {i} has a coordinate that is not finite"
        )));
    }
    if let Some(i) = contact_blocks.iter().position(|b| !b.is_finite()) {
        return Err(BodyError(format!("contact block {i} is not finite")));
    }
    for (t, triangle) in triangles.iter().enumerate() {
        if triangle.iter().any(|&n| n as usize >= nodes.len()) {
            return Err(BodyError(format!(
                "triangle {t} names a node beyond the {} nodes given",
                nodes.len()
            )));
        }
    }
    Ok(())
}

fn measure_faces(nodes: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<Face>, BodyError> {
    let unset = HalfEdge {
        triangle: u32::MAX,
        edge: 0,
    };
    triangles
        .iter()
        .enumerate()
        .map(|(t, triangle)| {
            let corners = triangle.map(|n| nodes[n as usize]);
            let area_vector = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let normal = area_vector
                .try_normalize()
                .ok_or_else(|| BodyError(format!("triangle {t} has no area")))?;
            let longest = [0, 1, 2]
                .map(|k: usize| corners[k].distance_squared(corners[(k + 1) % 3]))
                .into_iter()
                .fold(0.0, f64::max);
            let inward = [0, 1, 2]
                .map(|k: usize| normal.cross((corners[(k + 1) % 3] - corners[k]).normalize()));
            Ok(Face {
                corners,
                area_vector,
                normal,
                inward,
                across: [unset; 3],
                fans: [u32::MAX; 3],
                // Differences are exact to a rounding, their products to a few (Higham 2002).
                slack: 16.0 * f64::EPSILON * (1.0 + longest / area_vector.length()),
            })
        })
        .collect()
}

fn check_volume(faces: &[Face]) -> Result<(), BodyError> {
    let origin = faces[0].corners[0];
    let six_volumes: f64 = faces
        .iter()
        .map(|f| (f.corners[0] - origin).dot(f.area_vector))
        .sum();
    if six_volumes > 0.0 {
        Ok(())
    } else {
        Err(BodyError(
            "the surface is turned inside out or encloses nothing; \
             triangles must be counter-clockwise seen from outside"
                .into(),
        ))
    }
}
