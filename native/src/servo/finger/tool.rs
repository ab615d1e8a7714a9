//! A finger whose tip is a tool.

use glam::{DMat3, DVec3};

use super::followed::Followed;
use super::touch::Touch;
use crate::control::coupling::{Contact, Coupler};
use crate::servo::snapshot::Snapshot;
use crate::tool::collider::Collider;
use crate::tool::shape::Pose;

/// The coupling sees a tool's stiffness smoothed over this time, s: it jumps where a point comes to
/// bear, which the force must not.
const STIFFNESS_SECONDS: f64 = 0.01;

/// The touch of a tool, as the coupling remembers it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ToolTouch {
    /// Where the probe was when it last did not touch, m, as the hand sees it.
    begin: DVec3,
    /// Smoothed, N/m, in the hand's axes.
    stiffness: DMat3,
    /// In the last tick, to the hand's axes.
    rotation: DMat3,
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
        let frame = &followed.moment.frame;
        let Ok(felt) = tool.felt().map(|felt| frame.felt(felt)) else {
            return Touch::nan(followed);
        };
        let mut followed = *followed;
        followed.found.inside = !tool.is_free();
        let mut turn = DVec3::ZERO;
        if let Some(pose) = tool.pose().map(|pose| frame.pose(pose)) {
            followed.shot.proxy = pose.position;
            let last = Pose {
                rotation: std::mem::replace(&mut self.rotation, pose.rotation),
                ..pose
            };
            turn = last.way_to(&pose).1;
        }
        if felt.pressed == 0 {
            self.begin = followed.shot.probe;
            self.stiffness = DMat3::ZERO;
            return Touch::none(&followed);
        }
        let dt = followed.moment.dt;
        self.stiffness += (felt.stiffness - self.stiffness) * (dt / (STIFFNESS_SECONDS + dt));
        let contact = Contact {
            stiffness: self.stiffness,
            displacement: followed.shot.probe - self.begin,
            force: felt.force,
        };
        let coupled = followed.couple(coupler, &contact);
        let shot = Snapshot {
            contact_force: felt.force,
            torque: felt.torque,
            ..followed.shot
        };
        // Behind the coupling's spring force, torque and energy are less by one share.
        let share = if felt.force == DVec3::ZERO {
            1.0
        } else {
            coupled.spring.dot(felt.force) / felt.force.length_squared()
        };
        let is_settled = followed.presence == 1.0 && followed.is_ramped;
        let mut touch = Touch::of(&followed, shot, coupled.force).with_energy(
            -coupled.spring,
            (felt.energy * share, felt.own_energy * share),
            is_settled,
        );
        (touch.pressed.turn, touch.pressed.torque) = (turn, felt.torque * -share);
        touch.pressed.carried = felt.carried;
        touch.pressed.remembered = felt.remembered * share;
        touch
    }
}
