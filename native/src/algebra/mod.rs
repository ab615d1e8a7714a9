//! Small dense matrices, solved without allocating.

pub mod cholesky;
pub mod small_matrix;
pub(crate) mod wide;

/// Contact points that all tools on one body can have at once.
pub const MOST_POINTS: usize = 320;

/// From one row of a matrix between them to the next: an odd number of lines of a processor's cache, so that a
/// column lies in all of its sets.
pub(crate) const ROW: usize = MOST_POINTS + 8;

/// Room for numbers that are written before they are read. Not zeros: the system would give memory
/// for those page by page, in the tick.
pub(crate) fn room(count: usize) -> Vec<f64> {
    vec![f64::NAN; count]
}
