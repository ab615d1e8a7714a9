//! A body that nobody holds: its mass, where it is, what bears it.

use std::sync::Arc;

use glam::DVec3;

use super::free_body::FreeBody;
use super::placement::Placement;
use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::mobility::{Mobility, Motion};
use crate::engine::joint::{AllLed, Led};
use crate::tool::collider::{Collider, Felt};
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
    /// Its surface.
    pub body: Arc<Body>,
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
    /// Whether it is this body.
    pub fn is(&self, body: &Body) -> bool {
        std::ptr::eq(&raw const *self.body, body)
    }

    /// What its supports hold in it, J.
    pub fn held(&self) -> f64 {
        self.felt().map(|felt| felt.energy).sum()
    }

    /// What their pushes do on the displacements that it remembers, J.
    pub fn remembered(&self) -> f64 {
        self.felt().map(|felt| felt.remembered).sum()
    }

    fn felt(&self) -> impl Iterator<Item = &Felt> {
        let supports = self.supports.iter();
        supports.filter_map(|support| support.collider.felt().ok())
    }

    /// What its weight can give back, J, from the height of the world's origin on.
    pub fn raised(&self) -> f64 {
        let centre = self.placement.to_world(self.free.centre);
        -self.free.mass * self.gravity.dot(centre)
    }

    /// Forces of its supports on its nodes, at unit modulus.
    pub fn borne(&self) -> impl Iterator<Item = (u32, DVec3)> + '_ {
        let supports = self.supports.iter();
        supports.flat_map(|one| one.collider.nodal_forces(0).iter().copied())
    }

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
