//! The rest surface: geometry, neighbours across the free side, corner fans, pseudonormals.
//!
//! All of it is immutable after [`Body::new`], so the servo thread and tests share one `Arc`.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::body::between_nodes::BetweenNodes;
use crate::body::compliance::Compliance;
pub use crate::body::error::BodyError;
use crate::body::face::{Corner, Face, Fan, HalfEdge, measure_faces};
use crate::body::joining::{edges_by_nodes, gather_fans, join_edges};
use crate::body::normals::{is_soft, set_fan_normals};
use crate::body::response::{Response, places_of};
use crate::body::tree::Tree;

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
    reach: f64,
    response: Option<Response>,
    between_nodes: Option<BetweenNodes>,
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
        let reach = (nodes.iter()).fold(size, |most, node| most.max(node.abs().max_element()));
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
            reach,
            response: None,
            between_nodes: None,
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
                "{} free nodes are named for a compliance of {}; name as many",
                free_nodes.len(),
                compliance.node_count()
            )));
        }
        let places = places_of(free_nodes, self.nodes.len())?;
        self.response = Some(Response::gather(
            &self.triangles,
            &self.contact_blocks,
            compliance,
            places,
        ));
        Ok(self)
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
        body.between_nodes = Some(BetweenNodes::new(compliance, free_nodes, body.nodes.len()));
        Ok(body)
    }

    /// Whether any two nodes have a block.
    #[inline]
    pub fn is_whole(&self) -> bool {
        self.between_nodes.is_some()
    }

    /// L_ab at unit modulus for two nodes of the surface; `None` for a body that does not keep its
    /// whole compliance.
    ///
    /// A pinned node gives way to its own force as its contact block says, and to no other.
    #[inline]
    pub fn block(&self, a: u32, b: u32) -> Option<DMat3> {
        let kept = self.between_nodes.as_ref()?;
        Some(kept.block(a, b).unwrap_or_else(|| {
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
        let nodes = &self.triangles[triangle as usize];
        Some(self.response.as_ref()?.block(triangle, nodes, a, b))
    }

    /// L at unit modulus of the three corners of a triangle, a pinned one's from its contact block,
    /// and of its three edges, each between its ends in either order; `None` for a body without a
    /// compliance.
    #[inline]
    pub fn triangle_compliance(&self, triangle: u32) -> Option<[[DMat3; 3]; 2]> {
        let nodes = &self.triangles[triangle as usize];
        Some(self.response.as_ref()?.of_triangle(triangle, nodes))
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

    /// The largest coordinate of a node, m, and the size at least: what coordinates are rounded by.
    pub fn reach(&self) -> f64 {
        self.reach
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
    let most = u32::MAX / 4;
    if triangles.is_empty() || triangles.len() > most as usize {
        let count = triangles.len();
        let reason = format!("the body has {count} triangles; it must have from 1 to {most}");
        return Err(BodyError(reason));
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
            "node {i} is at {}; each coordinate must be finite",
            nodes[i]
        )));
    }
    if let Some(i) = contact_blocks.iter().position(|b| !b.is_finite()) {
        return Err(BodyError(format!(
            "contact block {i} is {}; each number must be finite",
            contact_blocks[i]
        )));
    }
    for (t, triangle) in triangles.iter().enumerate() {
        if triangle.iter().any(|&n| n as usize >= nodes.len()) {
            return Err(BodyError(format!(
                "triangle {t} names {triangle:?}, of which one is beyond the {} nodes given",
                nodes.len()
            )));
        }
    }
    Ok(())
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
