//! A finger whose tip is a tool.

use glam::{DMat3, DVec3};

use super::followed::Followed;
use super::touch::Touch;
use crate::control::coupling::{Contact, Coupler};
use crate::servo::snapshot::Snapshot;
use crate::tool::collider::Collider;

/// The coupling sees a tool's stiffness smoothed over this time, s: it jumps where a point comes to
/// bear, which the force must not.
const STIFFNESS_SECONDS: f64 = 0.01;

/// The touch of a tool, as the coupling remembers it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ToolTouch {
    /// Where the probe was when it last did not touch, m.
    begin: DVec3,
    /// Smoothed, N/m.
    stiffness: DMat3,
}

impl ToolTouch {
    /// The contact of a tool that was led.
    pub fn feel(
        &mut self,
        followed: &Followed<'_>,
        tool: &Collider,
        coupler: &mut Coupler,
    ) -> Touch {
        if !followed.is_sound {
            return Touch::none(followed);
        }
        let Ok(felt) = tool.felt() else {
            return Touch::nan(followed);
        };
        let mut followed = *followed;
        followed.found.inside = !tool.is_free();
        if let Some(pose) = tool.pose() {
            followed.shot.proxy = pose.position;
        }
        if felt.pressed == 0 {
            *self = Self {
                begin: followed.shot.probe,
                stiffness: DMat3::ZERO,
            };
            return Touch::none(&followed);
        }
        let dt = followed.moment.dt;
        self.stiffness += (felt.stiffness - self.stiffness) * (dt / (STIFFNESS_SECONDS + dt));
        let contact = Contact {
            stiffness: self.stiffness,
            displacement: followed.shot.probe - self.begin,
            force: felt.force,
        };
        let wanted = followed.couple(coupler, &contact).force;
        let shot = Snapshot {
            contact_force: felt.force,
            torque: felt.torque,
            ..followed.shot
        };
        Touch::of(&followed, shot, wanted)
    }
}
