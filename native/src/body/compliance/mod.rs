//! The compliance in either form, read block by block.
//!
//! L_ij is the displacement of free surface node i per force on node j at unit modulus. Blocks are
//! read where they lie, among hundreds of megabytes; nothing is allocated or copied for one.

mod compressed;
mod dense;
mod either;
mod error;
mod product;
pub mod table;

use glam::{DMat3, DVec3};

pub use compressed::{Compressed, CompressedParts};
pub use dense::Dense;
pub use either::Either;
pub use error::ComplianceError;

/// The inverse stiffness of the free surface nodes.
#[derive(Debug)]
pub enum Compliance {
    /// Every number stored.
    Dense(Dense),
    /// A few percent of the bytes.
    Compressed(Box<Compressed>),
}

impl Compliance {
    /// Number of free surface nodes.
    #[inline]
    pub fn node_count(&self) -> usize {
        match self {
            Self::Dense(dense) => dense.nodes,
            Self::Compressed(compressed) => compressed.nodes,
        }
    }

    /// Name of this form in files and panels.
    pub const fn form(&self) -> &'static str {
        match self {
            Self::Dense(_) => "dense",
            Self::Compressed(_) => "compressed",
        }
    }

    /// L_ij: displacement of node `i` per force on node `j`.
    ///
    /// # Panics
    /// Beyond the nodes.
    #[inline]
    pub fn block(&self, i: usize, j: usize) -> DMat3 {
        assert!(i < self.node_count() && j < self.node_count(), "{i}, {j}");
        match self {
            Self::Dense(dense) => dense.block(i, j),
            Self::Compressed(compressed) => compressed.block(i, j),
        }
    }

    /// Displacements of all nodes under forces on some of them, by node number (15); allocates.
    ///
    /// # Panics
    /// Beyond the nodes.
    pub fn apply(&self, loads: &[(usize, DVec3)]) -> Vec<DVec3> {
        match self {
            Self::Dense(dense) => dense.apply(loads),
            Self::Compressed(compressed) => compressed.apply(loads),
        }
    }
}
