//! How a body that nobody holds moves as a whole in a tick.
//!
//! It is drawn through a drag proportional to its mass: a force on it shifts and turns it at a rate, and
//! a tick by so much. Put into the compliance between contact points that motion is found together with
//! their forces, and stays stable however stiff the body is.

use glam::{DMat3, DVec3};

/// How far wrenches move a body in one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mobility {
    /// Centre of mass at rest, m.
    pub centre: DVec3,
    /// Shift per force along the ways that it may go, m/N at unit modulus.
    pub shift: f64,
    /// Takes a direction to its part along these ways.
    pub ways: DMat3,
    /// Turn per torque about the centre, rad/(N m) at unit modulus.
    pub turn: DMat3,
    /// Shift by the weight, m.
    pub drift: DVec3,
}

/// A small motion as a whole.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Motion {
    /// About where it turns, m.
    pub centre: DVec3,
    /// Of the centre, m.
    pub shift: DVec3,
    /// About an axis by its length, rad.
    pub turn: DVec3,
}

impl Motion {
    /// How far it takes a place, m.
    #[inline]
    pub fn at(&self, place: DVec3) -> DVec3 {
        self.shift + self.turn.cross(place - self.centre)
    }

    /// How far it takes anything within a distance of the centre at most, m.
    #[inline]
    pub fn most(&self, reach: f64) -> f64 {
        self.shift.length() + self.turn.length() * reach
    }

    /// Whether all of it are finite numbers.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.shift.is_finite() && self.turn.is_finite()
    }
}

impl Mobility {
    /// How far one place goes with the body under a force on another, m/N at unit modulus.
    #[inline]
    pub fn between(&self, seen: DVec3, loaded: DVec3) -> DMat3 {
        let [seen, loaded] = [seen, loaded].map(|place| crossing(place - self.centre));
        self.shifts() - seen * self.turn * loaded
    }

    /// How forces shift it, m/N at unit modulus.
    #[inline]
    pub(crate) fn shifts(&self) -> DMat3 {
        self.ways * self.shift
    }

    /// How unit forces along the axes turn it, at a place so far from its centre, rad/N at unit modulus.
    #[inline]
    pub(crate) fn turns(&self, arm: DVec3) -> DMat3 {
        self.turn * crossing(arm)
    }

    /// Where weight and forces at places take the body.
    pub fn motion(&self, forces: impl Iterator<Item = (DVec3, DVec3)>) -> Motion {
        let (mut sum, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        for (place, force) in forces {
            sum += force;
            torque += (place - self.centre).cross(force);
        }
        Motion {
            centre: self.centre,
            shift: self.drift + self.ways * (sum * self.shift),
            turn: self.turn * torque,
        }
    }

    /// Whether forces move the body alike: by another weight at most.
    #[inline]
    pub fn is_alike(&self, other: &Self) -> bool {
        (self.centre, self.shift, self.turn, self.ways)
            == (other.centre, other.shift, other.turn, other.ways)
    }
}

/// The matrix of the vector product with a vector.
#[inline]
fn crossing(v: DVec3) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(0.0, v.z, -v.y),
        DVec3::new(-v.z, 0.0, v.x),
        DVec3::new(v.y, -v.x, 0.0),
    )
}
