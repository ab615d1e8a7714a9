//! A body as a rigid one: what it weighs, and the drag that draws it to rest.

use glam::{DMat3, DVec3};

use crate::contact::mobility::Mobility;

/// Mass and drag of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeBody {
    /// kg.
    pub mass: f64,
    /// At rest, m.
    pub centre: DVec3,
    /// About the centre of mass, kg m^2.
    pub inertia: DMat3,
    /// Its speed under a force is the force over the mass, for so long, s.
    pub drag_time: f64,
}

impl FreeBody {
    /// Whether all of it can be reckoned with.
    pub fn is_sound(&self) -> bool {
        let is_positive = |number: f64| number.is_finite() && number > 0.0;
        let inertia = self.inertia;
        is_positive(self.mass)
            && is_positive(self.drag_time)
            && self.centre.is_finite()
            && inertia.is_finite()
            && is_positive(inertia.determinant())
            && is_positive(inertia.x_axis.x)
            && is_positive(inertia.x_axis.x * inertia.y_axis.y - inertia.x_axis.y.powi(2))
    }

    /// How wrenches move it in `dt` s; gravity, m/s^2, in its frame.
    pub fn mobility(&self, gravity: DVec3, young_modulus: f64, dt: f64) -> Mobility {
        let time = dt * self.drag_time;
        let turn = self.inertia.inverse() * (time * young_modulus);
        Mobility {
            centre: self.centre,
            shift: time * young_modulus / self.mass,
            turn: (turn + turn.transpose()) * 0.5,
            drift: gravity * time,
        }
    }
}
