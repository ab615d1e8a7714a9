//! How far to the side a tool may push a point of the surface.
//!
//! Points round a sphere pressed about as deep as its radius would slide off round its equator, as
//! those of no real body do. So pushes are held near the direction that the pressed surface faces. A
//! signed distance is the greatest separation n x - h(n) among all directions n, with h the farthest
//! reach of the tool along n; here it is the greatest among the directions within the limit: the
//! distance to the tool grown by a cone. A tool may touch parts that face different ways, so a point
//! may besides be pushed near the direction that it faces itself, unless the tool has passed through
//! a part.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};

use super::circle::{Sinusoid, highest, peak};
use crate::tool::shape::{MOST_CORE_POINTS, Tool};

/// Largest angle between a push and the direction against which an even surface is pressed, rad.
const MOST_TILT: f64 = 50.0 / 180.0 * PI;
/// By how much more where the pressed points face different ways: at most this, were they all
/// opposed, rad.
const MORE_WHERE_UNEVEN: f64 = 100.0 / 180.0 * PI;
/// A push that goes out of the body by more than this cosine has come through a part.
const OUTWARD: f64 = 0.5;
/// One that leans so far that it goes into the body by less than this cosine counts by as much less.
const LEANING: f64 = 0.2;

/// Directions within an angle of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cone {
    axis: DVec3,
    cosine: f64,
    sine: f64,
}

/// How a tool pushes a place of the surface.
#[derive(Debug, Clone, Copy)]
pub struct Push {
    /// Along the tool's normal as it is held.
    pub by: DVec3,
    /// That normal, were it not.
    pub free: DVec3,
    /// The body's outward normal there.
    pub facing: DVec3,
}

/// Limit of the tilt: the directions that pushes are held within.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TiltLimit {
    /// Near what all pushes are held.
    common: Cone,
    /// Of the cone about what a point faces itself, if a push may be there instead.
    own: Option<(f64, f64)>,
}

impl TiltLimit {
    /// From pushes. Only what goes into the body counts: the far side of a thin part is pushed
    /// outwards, and the part would else be felt turned round. Of none, nowhere.
    ///
    /// A body that nobody holds may slide off a tool, edge on edge. Where all pushes together would
    /// lean farther from what they press than the limit, were there none, it is as much wider, up to
    /// none at all: it comes and goes without a jump. (As they lean within it, both the limit and none
    /// could hold, and the body would be pushed from one to the other.) One that is held stays under
    /// its tool, and so its pushes in the limit.
    pub fn of(pushes: impl Iterator<Item = Push>, is_held: bool) -> Option<Self> {
        let (mut facing, mut most, mut is_through) = (DVec3::ZERO, 0.0, false);
        let mut all = DVec3::ZERO;
        for Push {
            by,
            free,
            facing: normal,
        } in pushes
        {
            let (outward, length) = (by.dot(normal), by.length());
            let into = (-outward).max(0.0);
            facing += normal * into;
            most += into;
            if into > 0.0 {
                all += free * length.min(into / LEANING);
            }
            is_through |= outward > OUTWARD * length;
        }
        let length = facing.length();
        let leaning = if is_held || is_through {
            0.0
        } else {
            let into = -all.dot(facing) / (all.length() * length);
            (1.0 - into / MOST_TILT.cos()).clamp(0.0, 1.0)
        };
        let limit =
            MOST_TILT + MORE_WHERE_UNEVEN * (1.0 - length / most) + (PI - MOST_TILT) * leaning;
        (length > 0.0 && limit < PI).then(|| {
            let (sine, cosine) = limit.sin_cos();
            Self {
                common: Cone {
                    axis: -facing / length,
                    cosine,
                    sine,
                },
                own: (!is_through).then(|| (MOST_TILT.cos(), MOST_TILT.sin())),
            }
        })
    }

    /// The same in the frame that a rotation takes directions of to these.
    #[must_use]
    pub fn seen_from(self, rotation: &DMat3) -> Self {
        let common = Cone {
            axis: rotation.transpose() * self.common.axis,
            ..self.common
        };
        Self { common, ..self }
    }

    /// Whether a place is farther than told from a tool that is held, as is plain from one direction
    /// among those at the limit: that nearest to where the tool as it is lies.
    #[inline]
    pub fn is_beyond(&self, far: f64, free: (f64, DVec3), place: DVec3, tool: &Tool) -> bool {
        // No direction is farther than that of the tool as it is.
        free.0 > far
            && (self.common.on_rim(free.1)).is_some_and(|rim| tool.separation(place, rim) > far)
    }

    /// Distance and normal of a tool at a place, held; all of it in the tool's frame. `free` are those
    /// of the tool as it is, `facing` is the outward normal of the body there.
    #[inline]
    pub fn hold(
        &self,
        free: (f64, DVec3),
        place: DVec3,
        facing: DVec3,
        tool: &Tool,
    ) -> (f64, DVec3) {
        if self.common.holds(free.1) {
            return free;
        }
        let Some((cosine, sine)) = self.own else {
            return self.common.greatest(place, tool);
        };
        let own = Cone {
            axis: -facing,
            cosine,
            sine,
        };
        if own.holds(free.1) {
            return free;
        }
        let (common, own) = (self.common.greatest(place, tool), own.greatest(place, tool));
        if own.0 > common.0 { own } else { common }
    }
}

impl Cone {
    #[inline]
    fn holds(&self, direction: DVec3) -> bool {
        direction.dot(self.axis) >= self.cosine
    }

    /// The direction on its rim that is nearest to another; of none along the axis.
    #[inline]
    fn on_rim(&self, direction: DVec3) -> Option<DVec3> {
        let across = direction - self.axis * self.axis.dot(direction);
        let across = across.try_normalize()?;
        Some(self.axis * self.cosine + across * self.sine)
    }

    /// The greatest separation of a place from the tool among directions on its rim, and which.
    fn greatest(&self, place: DVec3, tool: &Tool) -> (f64, DVec3) {
        let first = self.axis.any_orthonormal_vector();
        let second = self.axis.cross(first);
        let sinusoid = |core: DVec3| {
            let offset = place - core;
            Sinusoid {
                level: self.cosine * offset.dot(self.axis),
                slope: DVec2::new(offset.dot(first), offset.dot(second)) * self.sine,
            }
        };
        let turn = match tool.core() {
            [core] => peak(&sinusoid(*core)),
            core => {
                let mut sinusoids = [Sinusoid::default(); MOST_CORE_POINTS];
                for (sinusoid_of, &core) in sinusoids.iter_mut().zip(core) {
                    *sinusoid_of = sinusoid(core);
                }
                highest(&sinusoids[..core.len()])
            }
        };
        let aside = first * turn.x + second * turn.y;
        let direction = self.axis * self.cosine + aside * self.sine;
        (tool.separation(place, direction), direction)
    }
}
