//! How far to the side a tool may push a point of the surface.
//!
//! Points round a sphere pressed about as deep as its radius would slide off round its equator, as
//! those of no real body do. So a push is held near the inward normal at rest: beyond the limit a
//! sphere acts as if it widened into the cone that touches it there. Readable reference: `core/tilt.py`.

use glam::DVec3;

/// Shorter than this, what is aside of the inward normal has no direction.
const NO_SIDE: f64 = f64::EPSILON;

/// Largest angle between a push and the inward normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    cosine: f64,
    sine: f64,
}

impl Limit {
    /// Of an angle from 0 to pi, rad.
    pub fn new(angle: f64) -> Self {
        Self {
            cosine: angle.cos(),
            sine: angle.sin(),
        }
    }

    /// Whether it is one at all.
    pub fn is_finite(&self) -> bool {
        self.cosine.is_finite() && self.sine >= 0.0
    }

    /// Distance and normal of a tool of so large a radius, held within the limit of `inward`.
    #[inline]
    pub fn hold(
        &self,
        (distance, normal): (f64, DVec3),
        inward: DVec3,
        radius: f64,
    ) -> (f64, DVec3) {
        let along = normal.dot(inward).clamp(-1.0, 1.0);
        if along >= self.cosine {
            return (distance, normal);
        }
        let aside = normal - inward * along;
        let length = aside.length();
        if length <= NO_SIDE {
            return (distance, normal);
        }
        // The cosine of how much the tilt is over the limit.
        let over = along * self.cosine + length * self.sine;
        let held = inward * self.cosine + aside * (self.sine / length);
        ((distance + radius) * over - radius, held)
    }
}
