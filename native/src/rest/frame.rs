//! A body's frame as a hand sees it: at rest for a body that is held, else where its placement is.

use glam::{DMat3, DVec3};

use super::placement::Placement;
use crate::tool::collider::Felt;
use crate::tool::shape::Pose;

/// From a body's frame to that of the hand. Where the body is held the two are one, to the bit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Frame(Option<Placement>);

impl Frame {
    /// Of a body that is placed there.
    pub fn of(placement: Placement) -> Self {
        Self(Some(placement))
    }

    /// Where the body is; at rest where it is held.
    pub fn placement(&self) -> Placement {
        self.0.unwrap_or_default()
    }

    /// Whether the body is held.
    pub fn is_held(&self) -> bool {
        self.0.is_none()
    }

    /// A pose that the hand has, as seen from the body.
    #[inline]
    pub fn to_body(&self, pose: &Pose) -> Pose {
        self.0.map_or(*pose, |placement| placement.to_body(pose))
    }

    /// A place of the body, as the hand sees it.
    #[inline]
    pub fn place(&self, place: DVec3) -> DVec3 {
        self.0.map_or(place, |placement| placement.to_world(place))
    }

    /// A pose on the body, as the hand sees it.
    #[inline]
    pub fn pose(&self, pose: &Pose) -> Pose {
        self.0
            .map_or(*pose, |placement| placement.pose_to_world(pose))
    }

    /// A direction of the body, as the hand sees it.
    #[inline]
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.0
            .map_or(direction, |placement| placement.rotation * direction)
    }

    /// A symmetric matrix of the body, such as a stiffness, as the hand sees it.
    #[inline]
    pub fn matrix(&self, matrix: DMat3) -> DMat3 {
        self.0.map_or(matrix, |placement| {
            let turn = DMat3::from_quat(placement.rotation);
            turn * matrix * turn.transpose()
        })
    }

    /// What a tool felt on the body, as the hand sees it.
    pub fn felt(&self, felt: &Felt) -> Felt {
        Felt {
            force: self.direction(felt.force),
            torque: self.direction(felt.torque),
            stiffness: self.matrix(felt.stiffness),
            carried: self.direction(felt.carried),
            ..*felt
        }
    }
}
