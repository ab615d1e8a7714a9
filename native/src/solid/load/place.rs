//! Places of a body's surface that tools may meet.

use glam::DVec3;

use super::hold::Hold;
use crate::solid::domains::Nodal;

/// A place of the surface that a tool is kept out of.
#[derive(Debug, Clone)]
pub struct Place {
    /// The free nodes about it.
    pub corners: [u32; 3],
    /// The same nodes among those whose compliance is known.
    pub known: [u32; 3],
    /// Its area coordinates; none of what does not move.
    pub alpha: [f64; 3],
    /// At rest, m.
    pub rest: DVec3,
    /// Force over depth, N/m at 1 Pa.
    pub firmness: f64,
    /// Which tool.
    pub tool: usize,
    /// What holds it against going aside; none where the tool is smooth.
    pub hold: Option<Hold>,
}

impl Place {
    /// The mean of what its nodes have.
    pub(super) fn mean(&self, values: &Nodal) -> DVec3 {
        (self.corners.iter().zip(&self.alpha))
            .map(|(&node, &share)| share * DVec3::from_array(values[node as usize]))
            .sum()
    }

    /// Its nodes that move: among the free ones, among those known, and their shares.
    pub(super) fn moving(&self) -> impl Iterator<Item = (u32, usize, f64)> {
        let nodes = self.corners.iter().zip(&self.known).zip(&self.alpha);
        nodes
            .map(|((&node, &known), &share)| (node, known as usize, share))
            .filter(|&(_, _, share)| share != 0.0)
    }

    /// Adds a force to those of its nodes.
    pub(super) fn add(&self, force: DVec3, forces: &mut Nodal) {
        for (&node, &share) in self.corners.iter().zip(&self.alpha) {
            for (sum, part) in forces[node as usize].iter_mut().zip(force.to_array()) {
                *sum += share * part;
            }
        }
    }
}
