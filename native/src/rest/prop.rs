//! A body that nobody holds: its mass, where it is, what bears it.

use glam::DVec3;

use super::free_body::FreeBody;
use super::placement::Placement;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::mobility::{Mobility, Motion};
use crate::engine::joint::{AllLed, Led};
use crate::tool::collider::Collider;
use crate::tool::shape::Pose;

/// A fixed tool that bears a body.
#[derive(Debug, Clone)]
pub struct Support {
    /// With contact points on the body.
    pub collider: Collider,
    /// In the world.
    pub pose: Pose,
}

/// A body that nobody holds.
#[derive(Debug, Clone)]
pub struct Prop {
    /// Mass and drag.
    pub free: FreeBody,
    /// Where it is.
    pub placement: Placement,
    /// In the world, m/s^2.
    pub gravity: DVec3,
    /// What bears it.
    pub supports: Vec<Support>,
}

impl Prop {
    /// How wrenches move it in `dt` s.
    pub fn mobility(&self, young_modulus: f64, dt: f64) -> Mobility {
        let gravity = self.placement.direction_to_body(self.gravity);
        self.free.mobility(gravity, young_modulus, dt)
    }

    /// Has the supports be where they are, as seen from the body.
    pub fn lead<'a>(&'a mut self, led: &mut AllLed<'a>) {
        let placement = self.placement;
        for (led, support) in led[MAX_FINGERS..].iter_mut().zip(&mut self.supports) {
            *led = Some(Led {
                goal: placement.to_body(&support.pose),
                collider: &mut support.collider,
                presence: 1.0,
            });
        }
    }

    /// It has moved as a whole.
    pub fn move_on(&mut self, motion: &Motion) {
        if motion.is_finite() {
            self.placement = self.placement.moved(motion);
        }
    }
}
