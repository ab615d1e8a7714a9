//! The compliance in both of its forms, block by block.
//!
//! L_ij is the displacement of free surface node i per force on node j at unit modulus. Blocks are
//! read where they lie, among hundreds of megabytes; nothing is allocated or copied for one.

pub(crate) mod between_nodes;
mod compressed;
mod dense;
pub mod table;

use std::fmt;

use glam::{DMat3, DVec3};

pub use compressed::{Compressed, CompressedParts};
pub use dense::Dense;

use crate::body::compliance::table::Table;

/// Why a compliance cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ComplianceError(pub String);

impl fmt::Display for ComplianceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ComplianceError {}

fn refuse<T>(reason: String) -> Result<T, ComplianceError> {
    Err(ComplianceError(reason))
}

/// A table in one of two types of number.
#[derive(Debug)]
pub enum Either<A, B> {
    /// The shorter type.
    Short(Table<A>),
    /// The longer one.
    Long(Table<B>),
}

impl<A, B> Either<A, B>
where
    A: Copy + Send + Sync + Into<f64> + 'static,
    B: Copy + Send + Sync + Into<f64> + 'static,
{
    fn len(&self) -> usize {
        match self {
            Self::Short(table) => table.len(),
            Self::Long(table) => table.len(),
        }
    }

    #[inline]
    fn at(&self, place: usize) -> f64 {
        match self {
            Self::Short(table) => table[place].into(),
            Self::Long(table) => table[place].into(),
        }
    }

    #[inline]
    fn some<const N: usize>(&self, place: usize) -> [f32; N] {
        match self {
            Self::Short(table) => some(table, place).map(|number: A| number.into() as f32),
            Self::Long(table) => some(table, place).map(|number: B| number.into() as f32),
        }
    }
}

/// `N` numbers from `place` on.
#[inline]
fn some<T: Copy, const N: usize>(table: &[T], place: usize) -> [T; N] {
    *table[place..].first_chunk().expect("parts were checked")
}

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

    /// What files and panels call this form.
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
