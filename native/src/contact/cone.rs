//! The cone that a force which only pushes stays in.

use glam::{DMat3, DVec3};

use crate::contact::touch::inverse_of_definite;

/// A cone is never narrower than this tangent of its half angle.
const NARROWEST_CONE: f64 = 1.0;

/// The cone that a finger's force stays in.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cone {
    /// Unit vector of its push, zero without one.
    axis: DVec3,
    /// Tangent of the half angle; infinite for all forces.
    width: f64,
}

impl Cone {
    /// About a push, where the surface gives way by `own` for this finger alone: twice as wide as
    /// its force then needs, so that alone none is ever limited. `None` unless `own` is definite.
    pub fn about(push: DVec3, own: &DMat3) -> Option<Self> {
        let axis = push.normalize_or_zero();
        let alone = inverse_of_definite(own)? * axis;
        let along = alone.dot(axis);
        let across = (alone - axis * along).length();
        let ratio = if along > 0.0 { across / along } else { 0.0 };
        Some(Self {
            axis,
            width: NARROWEST_CONE.max(2.0 * ratio),
        })
    }

    /// About a direction of unit length, so wide; of no width it is a ray.
    pub fn of(axis: DVec3, width: f64) -> Self {
        Self { axis, width }
    }

    /// All forces: it holds what it acts on.
    pub fn everywhere() -> Self {
        Self::of(DVec3::ZERO, f64::INFINITY)
    }

    /// How far along and how far across its axis a force is.
    fn split(&self, force: DVec3) -> (f64, DVec3) {
        let along = force.dot(self.axis);
        (along, force - self.axis * along)
    }

    /// The force nearest to `force` in the cone; zero for a cone without an axis.
    pub(super) fn nearest(&self, force: DVec3) -> DVec3 {
        if self.width == f64::INFINITY {
            return force;
        }
        let (along, sideways) = self.split(force);
        let across = sideways.length();
        if self.axis == DVec3::ZERO || along <= -self.width * across {
            return DVec3::ZERO;
        }
        if across <= self.width * along {
            return force;
        }
        let length = (along + self.width * across) / (1.0 + self.width * self.width);
        self.axis * length + sideways * (self.width * length / across)
    }

    /// Derivative of [`nearest`](Self::nearest); times the force itself it gives that.
    pub(super) fn derivative(&self, force: DVec3) -> DMat3 {
        if self.width == f64::INFINITY {
            return DMat3::IDENTITY;
        }
        let (along, sideways) = self.split(force);
        let across = sideways.length();
        if self.axis == DVec3::ZERO || along <= -self.width * across {
            return DMat3::ZERO;
        }
        if self.width == 0.0 {
            return outer(self.axis);
        }
        if across <= self.width * along {
            return DMat3::IDENTITY;
        }
        let sideways = sideways / across;
        let edge = self.axis + sideways * self.width;
        let share = 1.0 / (1.0 + self.width * self.width);
        let turning = self.width * share * (along + self.width * across) / across;
        let around = DMat3::IDENTITY - outer(self.axis) - outer(sideways);
        outer(edge) * share + around * turning
    }
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}
