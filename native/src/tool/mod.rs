//! Rigid tools against the body: a fingertip, plate, rod or convex hull, in the tick.
//!
//! The [`shape`] of a tool meets [`points`] fixed on the body's surface; those near it form a
//! [`patch`], whose forces may only push ([`complementarity`]). [`contact`] follows the pose from tick
//! to tick. Readable references: `core/tools.py`, `core/contact_points.py`, `core/tool_contact.py`.

mod blocks;
pub mod cholesky;
pub mod complementarity;
pub mod contact;
pub mod effort;
pub mod friction;
pub mod hull;
pub mod near_field;
pub mod patch;
pub mod points;
pub mod shape;
pub mod tilt;
mod tree;
mod wide;

/// Contact points that can be under a tool at once.
pub const MOST_POINTS: usize = 160;

/// From one row of a matrix between them to the next: an odd number of lines of a processor's cache, so that a
/// column lies in all of its sets.
const ROW: usize = MOST_POINTS + 8;

/// Room for numbers that are written before they are read. Not zeros: the system would give memory
/// for those page by page, in the tick.
fn room(count: usize) -> Vec<f64> {
    vec![f64::NAN; count]
}
