//! A table whose numbers are of one of two types.

use crate::body::compliance::table::Table;

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
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Short(table) => table.len(),
            Self::Long(table) => table.len(),
        }
    }

    #[inline]
    pub(super) fn at(&self, place: usize) -> f64 {
        match self {
            Self::Short(table) => table[place].into(),
            Self::Long(table) => table[place].into(),
        }
    }

    #[inline]
    pub(super) fn some<const N: usize>(&self, place: usize) -> [f32; N] {
        match self {
            Self::Short(table) => some(table, place).map(|number: A| number.into() as f32),
            Self::Long(table) => some(table, place).map(|number: B| number.into() as f32),
        }
    }
}

/// `N` numbers from `place` on.
#[inline]
pub(super) fn some<T: Copy, const N: usize>(table: &[T], place: usize) -> [T; N] {
    *table[place..].first_chunk().expect("parts were checked")
}
