//! What presses a body that nobody holds, without a device: a tool, or a point of its surface.

use glam::DVec3;

use super::placement::Placement;
use crate::body::surface::Body;
use crate::contact::cones::Cone;
use crate::engine::joint::Led;
use crate::fingers::press::{Answer, Press};
use crate::proxy::SurfacePoint;
use crate::tool::collider::Collider;
use crate::tool::shape::Pose;

/// A point that was taken hold of, or that only presses.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Where on the surface.
    pub hold: SurfacePoint,
    /// It holds the place, and so may pull it; otherwise it only pushes, with this friction.
    pub friction: Option<f64>,
    /// Where the place is to go, in the world, m.
    pub goal: DVec3,
    /// On the body, at unit modulus, in its axes.
    pub force: DVec3,
    /// What it holds in the body, J at unit modulus.
    pub energy: f64,
}

/// A finger, with its goal in the world.
#[derive(Debug, Clone)]
pub enum Finger {
    /// A tool and where it is to go.
    Tool(Box<Collider>, Pose),
    /// A point.
    Point(Point),
}

impl Finger {
    /// The tool, if it is one.
    pub fn tool(&self) -> Option<&Collider> {
        match self {
            Self::Tool(tool, _) => Some(tool),
            Self::Point(_) => None,
        }
    }

    /// Begins anew.
    pub fn lift(&mut self) {
        match self {
            Self::Tool(tool, _) => tool.lift(),
            Self::Point(point) => (point.force, point.energy) = (DVec3::ZERO, 0.0),
        }
    }

    /// The tool and where it is to go on a body placed there.
    pub fn lead(&mut self, placement: &Placement) -> Option<Led<'_>> {
        match self {
            Self::Tool(collider, goal) => Some(Led {
                goal: placement.to_body(goal),
                collider,
                presence: 1.0,
            }),
            Self::Point(_) => None,
        }
    }

    /// The point as others see it, on a body placed there.
    pub fn press(&self, body: &Body, placement: &Placement) -> Option<Press> {
        let Self::Point(point) = self else {
            return None;
        };
        let face = body.face(point.hold.triangle);
        let displacement = placement.place_to_body(point.goal) - face.at(point.hold.alpha);
        Some(Press {
            body: 0,
            hold: point.hold,
            touches: true,
            displacement,
            push: displacement,
            cone: Some(match point.friction {
                Some(friction) => Cone::of(-face.normal, friction),
                None => Cone::everywhere(),
            }),
            most_stiffness: f64::INFINITY,
            presence: 1.0,
            remembered: DVec3::ZERO,
            carried: DVec3::ZERO,
        })
    }

    /// Takes over what became of the point.
    pub fn take(&mut self, answer: &Answer) {
        if let Self::Point(point) = self {
            (point.force, point.energy) = (answer.force, answer.energy);
        }
    }

    /// The forces on the body and where, at unit modulus.
    pub fn pushes<'a>(&'a self, body: &'a Body) -> impl Iterator<Item = (DVec3, DVec3)> + 'a {
        let tool = self.tool().map_or(&[][..], Collider::pressed);
        let point = match self {
            Self::Point(point) => Some((
                body.face(point.hold.triangle).at(point.hold.alpha),
                point.force,
            )),
            Self::Tool(..) => None,
        };
        let pressed = tool.iter().map(|slot| (slot.arm, slot.force));
        pressed.chain(point)
    }

    /// Felt, N.
    pub fn force(&self, young_modulus: f64) -> DVec3 {
        match self {
            Self::Tool(tool, _) => tool.felt().map_or(DVec3::NAN, |felt| felt.force),
            Self::Point(point) => -point.force * young_modulus,
        }
    }
}
