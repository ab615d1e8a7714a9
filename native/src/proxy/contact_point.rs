//! The contact point that makes the force: it follows the god object, smoothly and with friction.
//!
//! The god object alone judges what touches. Under a facet's border it jumps by the depth times
//! the sine of the angle between facets; here that jump becomes a motion:
//! - with shading the contact point is the continuous one of [`super::shading`], where there is
//!   one, and the god object otherwise;
//! - towards whichever it is it moves only a share of the device's own way in a tick ahead of the
//!   device, and never stays behind by more than a small angle seen from the device. So nothing
//!   lags at no depth, and at rest it arrives within some milliseconds. It only ever nears its
//!   aim, so like friction it takes energy and gives none;
//! - with friction ([`super::friction`]) it sticks and slips on its own.

use glam::DVec3;

use crate::body::surface::Body;
use crate::proxy::descent::descend;
use crate::proxy::feel::Feel;
use crate::proxy::friction::Friction;
use crate::proxy::place::SurfacePoint;
use crate::proxy::shading::shaded;

/// Share of the device's own way that the contact point may gain on it in a tick.
const GAIN: f64 = 0.7;
/// At rest what lags is made up with this time constant, s,
const CATCH_UP: f64 = 0.005;
/// and at least at this speed, m/s.
const CREEP: f64 = 0.001;
/// Tangent of the largest angle by which the force may lag, seen from the device.
const LARGEST_LAG: f64 = 0.35;
/// Farthest shaded point from the god object, in depths.
const FARTHEST_SHADE: f64 = 1.0;

/// Farthest contact point from the device in depths of the god object, without friction.
const LONGEST_REACH: f64 = 2.0;

/// Contact point and its memory.
#[derive(Debug, Clone)]
pub(super) struct ContactPoint {
    pub(super) hold: SurfacePoint,
    pub(super) position: DVec3,
    pub(super) friction: Friction,
    device: DVec3,
    /// Landings of the god object when this contact began; None while free.
    landing: Option<u64>,
}

/// The god object after this tick.
pub(super) struct Judged {
    pub(super) hold: SurfacePoint,
    pub(super) position: DVec3,
    /// Place where it met the surface, and how often it has done so.
    pub(super) entry: SurfacePoint,
    pub(super) landings: u64,
}

impl ContactPoint {
    pub(super) fn new(position: DVec3, hold: SurfacePoint) -> Self {
        Self {
            hold,
            position,
            friction: Friction::default(),
            device: position,
            landing: None,
        }
    }

    /// Off the surface.
    #[inline]
    pub(super) fn lift(&mut self, position: DVec3) {
        self.position = position;
        self.device = position;
        self.landing = None;
        self.friction = Friction::default();
    }

    /// Follows a god object that touches.
    pub(super) fn follow(
        &mut self,
        body: &Body,
        god: &Judged,
        device: DVec3,
        feel: &Feel,
        dt: f64,
    ) {
        self.follow_aim(body, god, device, feel, dt);
        // What is felt ends with the touch: no force without depth, however thin the triangles.
        let reach = device.distance_squared(self.position);
        let allowed = LONGEST_REACH * (1.0 + feel.static_friction);
        let is_within = reach <= allowed * allowed * device.distance_squared(god.position);
        if !is_within {
            (self.hold, self.position) = (god.hold, god.position);
        }
    }

    fn follow_aim(&mut self, body: &Body, god: &Judged, device: DVec3, feel: &Feel, dt: f64) {
        let moved = device - std::mem::replace(&mut self.device, device);
        let is_new = self.landing != Some(god.landings);
        self.landing = Some(god.landings);
        let mut spread = !is_new;
        if is_new {
            self.friction = Friction::default();
            self.put(body, god.entry);
        }
        let (mut aim, mut point) = (god.hold, god.position);
        if feel.static_friction > 0.0 {
            if let Some((hold, is_smooth)) = self.rub(body, god, device, feel, dt) {
                (aim, point) = (hold, body.face(hold.triangle).at(hold.alpha));
                spread &= is_smooth;
            }
            if aim == self.hold {
                return;
            }
        } else {
            // Friction that was switched off while it held must not say that it holds.
            self.friction = Friction::default();
            if feel.shading
                && let Some(smooth) = self.shade(body, god, device)
            {
                (aim, point) = (smooth, body.face(smooth.triangle).at(smooth.alpha));
            }
        }
        if !(spread && self.lag(body, (aim, point), device, moved, dt)) {
            (self.hold, self.position) = (aim, point);
        }
    }

    fn put(&mut self, body: &Body, hold: SurfacePoint) {
        self.hold = hold;
        self.position = body.face(hold.triangle).at(hold.alpha);
    }

    /// The shaded contact point, if it is one for this god object.
    fn shade(&self, body: &Body, god: &Judged, device: DVec3) -> Option<SurfacePoint> {
        let depth = device.distance(god.position);
        let found = shaded(body, self.hold.triangle, device, depth)
            .filter(|hold| is_near(body, hold, god, device, depth));
        if found.is_some() || self.hold.triangle == god.hold.triangle {
            return found;
        }
        shaded(body, god.hold.triangle, device, depth)
            .filter(|hold| is_near(body, hold, god, device, depth))
    }

    /// Place where friction leaves the contact point, and whether its way there is to be smooth.
    fn rub(
        &mut self,
        body: &Body,
        god: &Judged,
        device: DVec3,
        feel: &Feel,
        dt: f64,
    ) -> Option<(SurfacePoint, bool)> {
        let depth = device.distance(god.position);
        // A contact point may trail by its cone, widened for blocks that are stiffer one way than
        // another; what trails farther belongs to a surface that has passed.
        let farthest = depth * (2.0 * feel.static_friction + 1.0);
        let behind = self.position - god.position;
        if behind.length() > farthest {
            let nearer = god.position + behind * (farthest / behind.length());
            let hold = descend(body, god.hold, nearer);
            self.put(body, hold);
        }
        if body.face(self.hold.triangle).side(device) >= 0.0 {
            self.put(body, god.hold);
        }
        let slip = self.friction.follow(body, self.hold, device, feel, dt)?;
        let hold = slip.hold;
        (body.face(hold.triangle).side(device) <= 0.0).then_some((hold, !slip.broke_away))
    }

    /// Moves towards its aim as far as a smooth force allows; false when it may go there at once.
    fn lag(
        &mut self,
        body: &Body,
        (aim, point): (SurfacePoint, DVec3),
        device: DVec3,
        moved: DVec3,
        dt: f64,
    ) -> bool {
        let arm = point - device;
        let squared_depth = arm.length_squared();
        let way = point - self.position;
        // Only what lies across the force: the rest is the device's own pressing.
        let across = way * squared_depth - arm * way.dot(arm);
        let across_length = across.length();
        if across_length == 0.0 {
            return false;
        }
        let distance = across_length / squared_depth;
        let direction = across / across_length;
        let ahead = moved.dot(direction) + GAIN * moved.length();
        let advance = ahead.max(distance * dt / CATCH_UP).max(CREEP * dt);
        let rest = (distance - advance).min(LARGEST_LAG * squared_depth.sqrt());
        if rest <= 0.0 {
            return false;
        }
        let hold = descend(body, aim, point - direction * rest);
        let face = body.face(hold.triangle);
        let position = face.at(hold.alpha);
        if face.side(device) >= 0.0 || position.distance(point) > 2.0 * rest {
            return false;
        }
        (self.hold, self.position) = (hold, position);
        true
    }
}

fn is_near(body: &Body, hold: &SurfacePoint, god: &Judged, device: DVec3, depth: f64) -> bool {
    let face = body.face(hold.triangle);
    face.at(hold.alpha).distance(god.position) <= FARTHEST_SHADE * depth && face.side(device) <= 0.0
}
