//! Compliance between the nodes of one triangle.

use std::collections::HashMap;

use glam::DMat3;

use crate::body::compliance::Compliance;
use crate::body::error::BodyError;
use crate::body::joining::edge_nodes;

/// The place of a node that is pinned: it never moves.
const PINNED: u32 = u32::MAX;

/// Blocks of the compliance that contacts on one triangle need.
///
/// Copied from the compliance once: a tick must not wait for pages of a table of hundreds of
/// megabytes, nor end with the file that such a table may lie in.
#[derive(Debug)]
pub struct Response {
    /// L_aa of each node, the inverse of its contact block where it is pinned.
    own: Vec<DMat3>,
    /// Place of each node in the compliance.
    places: Vec<u32>,
    /// L_ab of each edge, a < b.
    between: Vec<DMat3>,
    /// Places in `between` of each triangle's three edges.
    edges: Vec<[u32; 3]>,
}

impl Response {
    /// Reads the blocks of all nodes and edges.
    pub fn gather(
        triangles: &[[u32; 3]],
        contact_blocks: &[DMat3],
        compliance: &Compliance,
        places: Vec<u32>,
    ) -> Self {
        let block = |a: u32, b: u32| match (places[a as usize], places[b as usize]) {
            (PINNED, _) | (_, PINNED) if a == b => contact_blocks[a as usize].inverse(),
            (PINNED, _) | (_, PINNED) => DMat3::ZERO,
            (a, b) => compliance.block(a as usize, b as usize),
        };
        let mut between = Vec::new();
        let mut numbers = HashMap::new();
        let edges = triangles
            .iter()
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
        Self {
            own: own.collect(),
            between,
            edges,
            places,
        }
    }

    /// L_ab for two corners of a triangle of `nodes`, zero where one is pinned.
    #[inline]
    pub fn block(&self, triangle: u32, nodes: &[u32; 3], a: usize, b: usize) -> DMat3 {
        if a == b {
            return if self.places[nodes[a] as usize] == PINNED {
                DMat3::ZERO
            } else {
                self.own[nodes[a] as usize]
            };
        }
        // Edge k runs from corner k to the next one: the edges without the corners 2, 0, 1.
        let edge = (4 - a - b) % 3;
        let block = self.between[self.edges[triangle as usize][edge] as usize];
        if nodes[a] < nodes[b] {
            block
        } else {
            block.transpose()
        }
    }

    /// L of the three corners of a triangle of `nodes`, and of its edges.
    #[inline]
    pub fn of_triangle(&self, triangle: u32, nodes: &[u32; 3]) -> [[DMat3; 3]; 2] {
        [
            nodes.map(|node| self.own[node as usize]),
            self.edges[triangle as usize].map(|edge| self.between[edge as usize]),
        ]
    }
}

/// Places of `node_count` nodes in a compliance of the free ones.
pub fn places_of(free_nodes: &[u32], node_count: usize) -> Result<Vec<u32>, BodyError> {
    let mut places = vec![PINNED; node_count];
    for (place, &node) in free_nodes.iter().enumerate() {
        match places.get_mut(node as usize) {
            Some(free @ &mut PINNED) => *free = place as u32,
            Some(_) => {
                return Err(BodyError(format!(
                    "node {node} is named free twice; name each once"
                )));
            }
            None => {
                return Err(BodyError(format!(
                    "free node {node} is beyond the {} nodes given; they are numbered from 0",
                    node_count
                )));
            }
        }
    }
    Ok(places)
}
