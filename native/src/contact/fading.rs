//! How a contact comes back gradually: after a fault, or over an edge.

/// Present by less, it presses no more than that.
const LEAST_PRESENCE: f64 = 1e-3;

/// By how much more a contact gives way than its bodies do, as a share of that, by its presence from 0
/// to 1.
#[inline]
pub fn fading(presence: f64) -> f64 {
    1.0 / presence.max(LEAST_PRESENCE) - 1.0
}
