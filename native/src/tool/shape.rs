//! A rigid tool: the convex hull of a few core points, grown by a ball, and its signed distance.
//!
//! One point is a sphere, two a rod with round ends, a box a plate with rounded edges. Distance and
//! normal are exact: outside the core by the closest point of the hull, inside it by the nearest face
//! (Ericson 2005, 5.1). Readable reference: `core/contact/tool/tools.py`.

mod circle;
pub mod hull;
pub mod tilt;

use glam::{DMat3, DQuat, DVec3};

use crate::tool::shape::hull::{Hull, HullError};

/// Core points that a tool may have.
pub const MOST_CORE_POINTS: usize = 64;
/// Share of its inner radius that a tool goes in one tick at most, so that it jumps over no wall.
const STRIDE_PER_INNER_RADIUS: f64 = 0.25;
/// Closer to the core than this share of the radius, the direction is rounding.
const CLEAR: f64 = 1e-9;

/// Where a tool is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Of its reference point, m, body coordinates.
    pub position: DVec3,
    /// Takes directions of the tool to directions of the body.
    pub rotation: DMat3,
}

impl Pose {
    /// Whether all of it are finite numbers.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.rotation.is_finite()
    }

    /// The same turn elsewhere.
    #[inline]
    pub fn moved(&self, by: DVec3) -> Self {
        Self {
            position: self.position + by,
            ..*self
        }
    }

    /// The way to another pose, m, and the turn, about an axis by its length in rad.
    #[inline]
    pub fn way_to(&self, goal: &Self) -> (DVec3, DVec3) {
        let turn = DQuat::from_mat3(&(goal.rotation * self.rotation.transpose())).normalize();
        (goal.position - self.position, turn.to_scaled_axis())
    }

    /// A place of the body in the tool's frame.
    #[inline]
    pub fn to_tool(&self, point: DVec3) -> DVec3 {
        self.rotation.transpose() * (point - self.position)
    }

    /// A place of the tool's frame on the body.
    #[inline]
    pub fn to_body(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.position
    }
}

/// The convex hull of core points, grown by a radius; m, in the tool's own frame.
#[derive(Debug, Clone)]
pub struct Tool {
    core: Vec<DVec3>,
    hull: Hull,
    radius: f64,
    reach: f64,
    low: DVec3,
    high: DVec3,
    middle: DVec3,
    stride: f64,
    is_endless: bool,
}

impl Tool {
    /// All that is below z = 0 in its frame: a floor without an edge. `reach`, m, stands for its size
    /// where one is asked for: displacements on it are found to some millionths of that.
    ///
    /// # Errors
    /// [`HullError`] for a reach that is not positive.
    pub fn endless(reach: f64) -> Result<Self, HullError> {
        let ball = Self::new(&[DVec3::ZERO], reach)?;
        Ok(Self {
            low: DVec3::splat(f64::NEG_INFINITY),
            high: DVec3::new(f64::INFINITY, f64::INFINITY, 0.0),
            radius: 0.0,
            stride: f64::INFINITY,
            is_endless: true,
            ..ball
        })
    }

    /// Whether it is a half-space, which has one normal and no other side.
    #[inline]
    pub fn is_endless(&self) -> bool {
        self.is_endless
    }

    /// A tool around its core points.
    ///
    /// # Errors
    /// [`HullError`] for no points or more than [`MOST_CORE_POINTS`], numbers that are not finite, a
    /// radius that is not positive.
    pub fn new(core: &[DVec3], radius: f64) -> Result<Self, HullError> {
        let refuse = |reason: String| Err(HullError(reason));
        if core.is_empty() || core.len() > MOST_CORE_POINTS {
            return refuse(format!(
                "a tool of {} core points; it must have from 1 to {MOST_CORE_POINTS}",
                core.len()
            ));
        }
        if let Some(i) = core.iter().position(|p| !p.is_finite()) {
            return refuse(format!(
                "core point {i} is {}; each coordinate must be finite",
                core[i]
            ));
        }
        if !(radius.is_finite() && radius > 0.0) {
            return refuse(format!(
                "the tool's radius is {radius}; it must be finite and greater than zero"
            ));
        }
        let hull = Hull::new(core);
        let middle = core.iter().sum::<DVec3>() / core.len() as f64;
        let inner_radius = radius + hull.depth(middle);
        Ok(Self {
            core: core.to_vec(),
            radius,
            reach: core.iter().map(|p| p.length()).fold(0.0, f64::max) + radius,
            low: core.iter().fold(DVec3::INFINITY, |low, &p| low.min(p)),
            high: core
                .iter()
                .fold(DVec3::NEG_INFINITY, |high, &p| high.max(p)),
            middle,
            stride: STRIDE_PER_INNER_RADIUS * inner_radius,
            hull,
            is_endless: false,
        })
    }

    /// The points that it was made of, m.
    #[inline]
    pub fn core(&self) -> &[DVec3] {
        &self.core
    }

    /// Radius of the ball, m.
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// From the reference point to the farthest point of the tool, m.
    #[inline]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// How far the tool moves in one tick at most, m.
    #[inline]
    pub fn stride(&self) -> f64 {
        self.stride
    }

    /// Mean of the core points.
    #[inline]
    pub fn middle(&self) -> DVec3 {
        self.middle
    }

    /// Signed distance of a point, negative inside, and the outward unit normal there.
    #[inline]
    pub fn distance(&self, point: DVec3) -> (f64, DVec3) {
        if self.is_endless {
            return (point.z, DVec3::Z);
        }
        let (distance, normal) = self.hull.distance(point, CLEAR * self.radius);
        (distance - self.radius, normal)
    }

    /// How far a place is from it along a direction of unit length, at most its distance. Not of an
    /// endless one.
    #[inline]
    pub fn separation(&self, place: DVec3, direction: DVec3) -> f64 {
        let nearest = |least: f64, core: &DVec3| least.min((place - *core).dot(direction));
        self.core.iter().fold(f64::INFINITY, nearest) - self.radius
    }

    /// Multiplications that a distance takes, about.
    #[inline]
    pub fn effort(&self) -> usize {
        20 + 10 * self.hull.face_count()
    }

    /// Less than the signed distance, or equal to it, at little cost.
    #[inline]
    pub fn least_distance(&self, point: DVec3) -> f64 {
        let outside = (self.low - point).max(point - self.high).max(DVec3::ZERO);
        outside.length() - self.radius
    }
}
