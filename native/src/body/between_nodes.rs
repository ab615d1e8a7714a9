//! A body's whole compliance, for contacts that reach over more than one triangle.

use std::sync::Arc;

use glam::DMat3;

use crate::body::compliance::Compliance;

/// The place of a node that is pinned.
const PINNED: u32 = u32::MAX;

/// The compliance and where each node of the surface stands in it.
#[derive(Debug)]
pub(crate) struct BetweenNodes {
    compliance: Arc<Compliance>,
    places: Vec<u32>,
}

impl BetweenNodes {
    /// `free_nodes` were checked: they lie within `nodes`, as many as the compliance counts.
    pub(crate) fn new(compliance: Arc<Compliance>, free_nodes: &[u32], nodes: usize) -> Self {
        let mut places = vec![PINNED; nodes];
        for (place, &node) in free_nodes.iter().enumerate() {
            places[node as usize] = place as u32;
        }
        Self { compliance, places }
    }

    /// L_ab at unit modulus, `None` where a node is pinned.
    #[inline]
    pub(crate) fn block(&self, a: u32, b: u32) -> Option<DMat3> {
        match (self.places[a as usize], self.places[b as usize]) {
            (PINNED, _) | (_, PINNED) => None,
            (a, b) => Some(self.compliance.block(a as usize, b as usize)),
        }
    }
}
