//! Where a body's frame is in the world.

use glam::{DMat3, DQuat, DVec3};

use crate::contact::mobility::Motion;
use crate::tool::shape::Pose;

/// The frame of a body in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Of the frame's origin, m.
    pub position: DVec3,
    /// Takes directions of the body to directions of the world; of unit length.
    pub rotation: DQuat,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
        }
    }
}

impl Placement {
    /// A pose in the world, as seen from the body.
    #[inline]
    pub fn to_body(&self, pose: &Pose) -> Pose {
        let back = self.rotation.inverse();
        Pose {
            position: back * (pose.position - self.position),
            rotation: DMat3::from_quat(back) * pose.rotation,
        }
    }

    /// A pose on the body, in the world.
    #[inline]
    pub fn pose_to_world(&self, pose: &Pose) -> Pose {
        Pose {
            position: self.to_world(pose.position),
            rotation: DMat3::from_quat(self.rotation) * pose.rotation,
        }
    }

    /// A place in the world, as seen from the body.
    #[inline]
    pub fn place_to_body(&self, place: DVec3) -> DVec3 {
        self.rotation.inverse() * (place - self.position)
    }

    /// A direction in the world, as seen from the body.
    #[inline]
    pub fn direction_to_body(&self, direction: DVec3) -> DVec3 {
        self.rotation.inverse() * direction
    }

    /// A place of the body, in the world.
    #[inline]
    pub fn to_world(&self, place: DVec3) -> DVec3 {
        self.position + self.rotation * place
    }

    /// The body has moved as a whole, by a motion in its own frame.
    #[must_use]
    pub fn moved(&self, by: &Motion) -> Self {
        let centre = self.to_world(by.centre + by.shift);
        let rotation = (self.rotation * DQuat::from_scaled_axis(by.turn)).normalize();
        Self {
            position: centre - rotation * by.centre,
            rotation,
        }
    }
}
