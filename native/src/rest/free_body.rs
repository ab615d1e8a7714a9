//! A body as a rigid one: what it weighs, the drag that draws it to rest, and whether a hand steadies it.

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
    /// Whether a hand keeps it from sliding and turning: it goes along gravity alone then.
    pub is_steady: bool,
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
        let turn = if self.is_steady {
            DMat3::ZERO
        } else {
            self.inertia.inverse() * (time * young_modulus)
        };
        Mobility {
            centre: self.centre,
            shift: time * young_modulus / self.mass,
            ways: self.ways(gravity),
            turn: (turn + turn.transpose()) * 0.5,
            drift: gravity * time,
        }
    }

    /// Takes a direction to its part along which it may go, where gravity is so.
    fn ways(&self, gravity: DVec3) -> DMat3 {
        if !self.is_steady {
            return DMat3::IDENTITY;
        }
        let down = gravity.normalize_or_zero();
        DMat3::from_cols(down * down.x, down * down.y, down * down.z)
    }

    /// What is left of a wrench that no hand takes; force and torque about the centre, N and N m.
    pub fn untaken(&self, gravity: DVec3, (force, torque): (DVec3, DVec3)) -> (DVec3, DVec3) {
        if self.is_steady {
            (self.ways(gravity) * force, DVec3::ZERO)
        } else {
            (force, torque)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(is_steady: bool) -> FreeBody {
        FreeBody {
            mass: 2.0,
            centre: DVec3::new(0.1, 0.2, 0.3),
            inertia: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)),
            drag_time: 0.5,
            is_steady,
        }
    }

    #[test]
    fn what_a_hand_steadies_goes_along_gravity_alone() {
        let gravity = DVec3::new(1.0, -2.0, 2.0) * 3.0;
        let down = gravity.normalize();
        let mobility = body(true).mobility(gravity, 10.0, 1e-3);
        let (place, force) = (DVec3::new(0.4, -0.1, 0.2), DVec3::new(0.3, 0.7, -0.2));
        let motion = mobility.motion([(place, force)].into_iter());
        let free = body(false).mobility(gravity, 10.0, 1e-3);
        let asked = free.motion([(place, force)].into_iter());
        assert_eq!(motion.turn, DVec3::ZERO);
        assert!(motion.shift.distance(down * down.dot(asked.shift)) < 1e-15);
        let between = mobility.between(place, DVec3::ZERO) * force;
        assert!(between.distance(down * down.dot(force) * mobility.shift) < 1e-15);
    }

    #[test]
    fn of_a_wrench_it_leaves_what_is_along_gravity() {
        let wrench = (DVec3::new(3.0, 4.0, 5.0), DVec3::ONE);
        let gravity = DVec3::NEG_Z * 9.81;
        assert_eq!(body(false).untaken(gravity, wrench), wrench);
        let (force, torque) = body(true).untaken(gravity, wrench);
        assert!(force.distance(DVec3::Z * 5.0) < 1e-15);
        assert_eq!(torque, DVec3::ZERO);
        assert_eq!(body(true).untaken(DVec3::ZERO, wrench).0, DVec3::ZERO);
    }
}
