//! Where fingers without a clock are to go, and what they came to.

use glam::{DMat3, DQuat, DVec3};

use crate::proxy::SurfacePoint;
use crate::tool::collider::Collider;
use crate::tool::shape::Pose;

/// Where a finger is to go.
#[derive(Debug, Clone, Copy)]
pub enum Goal {
    /// A point on a place of the surface, by how far it moves that from rest, m.
    Point(SurfacePoint, DVec3),
    /// A tool.
    Tool(Pose),
}

/// What touches the body.
#[derive(Debug, Clone)]
pub enum Toucher {
    /// A point.
    Point(PointTouch),
    /// A tool.
    Tool(Box<Collider>),
}

/// A point and what it last felt.
#[derive(Debug, Clone, Copy, Default)]
pub struct PointTouch {
    /// Where it touches, and how far it is from there, m; none before the first goal.
    pub at: Option<(SurfacePoint, DVec3)>,
    /// Felt, N.
    pub force: DVec3,
    /// On the nodes of its triangle, by the linear relation, N.
    pub nodal_forces: [DVec3; 3],
}

/// What keeps fingers from coming to rest.
#[derive(Debug, Clone, PartialEq)]
pub enum Unsettled {
    /// A finger's goal is for another kind of tip.
    OtherTip(usize),
    /// A finger's tool is too many strides away.
    TooFar(usize),
    /// From within the body no way leads a finger's tool out.
    NoWayOut(usize),
    /// A finger's force is no number.
    NotANumber(usize),
    /// Forces still change by this share, most of all a finger's.
    Moving(usize, f64),
}

/// A part of the way from one goal to another.
pub(super) fn between(start: &Goal, goal: &Goal, share: f64) -> Goal {
    match (start, goal) {
        _ if share >= 1.0 => *goal,
        (Goal::Point(_, from), Goal::Point(hold, to)) => Goal::Point(*hold, from.lerp(*to, share)),
        (Goal::Tool(from), Goal::Tool(to)) => {
            let (way, turn) = from.way_to(to);
            Goal::Tool(Pose {
                position: from.position + way * share,
                rotation: DMat3::from_quat(DQuat::from_scaled_axis(turn * share)) * from.rotation,
            })
        }
        _ => *goal,
    }
}
