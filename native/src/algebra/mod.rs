//! Small dense matrices, solved without allocating.

use glam::DMat3;

pub mod cholesky;
pub(crate) mod hashing;
mod panels;
pub mod small_matrix;
pub(crate) mod wide;

/// Contact points that all tools can have at once where there is no clock: memory is for so many.
pub const MOST_POINTS: usize = 416;

/// The same in a tick of 1 kHz, for which the exact solve of more takes too long.
pub const MOST_IN_TICK: usize = 208;

/// From one row of a matrix between them to the next: an odd number of lines of a processor's cache,
/// so that a column lies in all of its sets.
pub(crate) const ROW: usize = MOST_POINTS + 8;

/// Room for numbers that are written before they are read. Not zeros: the system would give memory
/// for those page by page, in the tick.
pub(crate) fn room(count: usize) -> Vec<f64> {
    vec![f64::NAN; count]
}

/// What share of a displacement a place of this stiffness takes where a spring of that compliance lies
/// in series with it, and what share of its force is left: (1 + cK)^-1.
pub fn series_share(stiffness: &DMat3, compliance: f64) -> DMat3 {
    if compliance > 0.0 {
        (DMat3::IDENTITY + *stiffness * compliance).inverse()
    } else {
        DMat3::IDENTITY
    }
}
