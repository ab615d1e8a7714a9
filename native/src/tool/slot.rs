//! A contact point near a tool, and all that is known of it there.

use glam::DVec3;

use super::points::Point;
use crate::creep::step::Trace;

/// Contact points that a tool can have near it at once.
pub const MOST_NEAR: usize = 160;
/// Nodes that can carry its force.
pub const MOST_NODES: usize = 3 * MOST_NEAR;

/// A contact point near a tool; where two tools share one, each has a slot for it.
#[derive(Debug, Clone, Copy)]
pub struct Slot {
    /// Number of the tool.
    pub tool: u8,
    /// Number of the body in the list.
    pub body: u8,
    /// Number of the contact point.
    pub point: u32,
    /// What is fixed there.
    pub at: Point,
    /// Force on the body, N at unit modulus.
    pub force: DVec3,
    /// The part of it along the normal, N at unit modulus.
    pub push: f64,
    /// The part of it across, by friction, N at unit modulus.
    pub aside: DVec3,
    /// Where on the tool the point stuck, in the tool's frame; nowhere before its second tick.
    pub anchor: Option<DVec3>,
    /// It slipped in the last tick.
    pub slips: bool,
    /// Displacement, m.
    pub moved: DVec3,
    /// Where forces on it act on the body as a whole: where it was at the beginning of the tick, or one a
    /// little before, m.
    pub arm: DVec3,
    /// The part of it that points cause, and what is remembered, m.
    pub offset: DVec3,
    /// The same before the points' forces were found anew, m.
    pub(crate) before: DVec3,
    /// What it remembers of its displacements over time.
    pub trace: Trace,
    /// How far that moves it in this tick, m.
    pub remembered: DVec3,
    /// The part of that which is new in this tick, m.
    pub carried: DVec3,
    /// Compliance between it and the tool along the normal, m/N at unit modulus.
    pub spring: f64,
    /// Outward from the tool where the point has gone to.
    pub normal: DVec3,
    /// Signed distance from the tool there, m.
    pub distance: f64,
    /// Distance and normal where the point is now, of the tool as it is, in the tool's frame.
    pub(crate) free: (f64, DVec3),
    /// The same as pushes are held, in the body's frame: what the next linearisation begins with.
    pub(crate) seen: (f64, DVec3),
    /// How far the point moves along an axis under a force along it, at most, m/N at unit modulus.
    pub(crate) gives: f64,
}

impl Slot {
    /// Whether it is one of a tool on a body.
    #[inline]
    pub(crate) fn is_of(&self, pair: [u8; 2]) -> bool {
        [self.tool, self.body] == pair
    }

    pub(super) fn new([tool, body]: [u8; 2], point: u32, at: &Point) -> Self {
        Self {
            tool,
            body,
            point,
            at: *at,
            force: DVec3::ZERO,
            push: 0.0,
            aside: DVec3::ZERO,
            anchor: None,
            slips: false,
            moved: DVec3::ZERO,
            arm: at.position,
            offset: DVec3::ZERO,
            trace: Trace::default(),
            remembered: DVec3::ZERO,
            carried: DVec3::ZERO,
            before: DVec3::ZERO,
            spring: 0.0,
            normal: DVec3::ZERO,
            distance: 0.0,
            free: (0.0, DVec3::ZERO),
            seen: (0.0, DVec3::ZERO),
            gives: 0.0,
        }
    }
}
