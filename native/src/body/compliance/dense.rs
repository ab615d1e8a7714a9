//! The dense compliance: every number stored, as in the paper.

use glam::{DMat3, DVec3};

use crate::body::compliance::either::Either;
use crate::body::compliance::error::{ComplianceError, refuse};

/// Every number of L: column j, axis c holds the displacements of all nodes.
#[derive(Debug)]
pub struct Dense {
    pub(super) nodes: usize,
    table: Either<f32, f64>,
}

impl Dense {
    /// L as a table (n, 3, 3n).
    ///
    /// # Errors
    /// [`ComplianceError`] when the table has not that many numbers.
    pub fn new(nodes: usize, table: Either<f32, f64>) -> Result<Self, ComplianceError> {
        if table.len() != 9 * nodes * nodes {
            return refuse(format!(
                "a dense table of {nodes} nodes has {} numbers, not {}",
                9 * nodes * nodes,
                table.len()
            ));
        }
        Ok(Self { nodes, table })
    }

    #[inline]
    pub(super) fn block(&self, i: usize, j: usize) -> DMat3 {
        let column = |axis: usize| {
            let first = (3 * j + axis) * 3 * self.nodes + 3 * i;
            DVec3::new(
                self.table.at(first),
                self.table.at(first + 1),
                self.table.at(first + 2),
            )
        };
        DMat3::from_cols(column(0), column(1), column(2))
    }

    pub(super) fn apply(&self, loads: &[(usize, DVec3)]) -> Vec<DVec3> {
        (0..self.nodes)
            .map(|i| loads.iter().map(|&(j, f)| self.block(i, j) * f).sum())
            .collect()
    }
}
