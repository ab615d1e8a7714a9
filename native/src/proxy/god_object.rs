//! The proxy: god object and contact point together.

use glam::DVec3;

use crate::body::surface::Body;
use crate::proxy::contact_point::{ContactPoint, Judged};
use crate::proxy::feel::Feel;
use crate::proxy::friction::nearest_normal;
use crate::proxy::place::{Place, SurfacePoint, snap};

/// The god object and the contact point that follows it.
#[derive(Debug, Clone)]
pub struct Proxy {
    pub(super) place: Place,
    pub(super) position: DVec3,
    pub(super) queried: DVec3,
    pub(super) hold: SurfacePoint,
    entry: SurfacePoint,
    landings: u64,
    contact: ContactPoint,
    pub(super) steps: u32,
    pub(super) rescues: u64,
}

impl Proxy {
    /// A proxy that was set down at `position`.
    pub fn new(body: &Body, position: DVec3) -> Self {
        let hold = SurfacePoint {
            triangle: 0,
            alpha: [1.0, 0.0, 0.0],
        };
        let mut proxy = Self {
            place: Place::Free {
                clearance: 0.0,
                blind: 0,
            },
            position,
            queried: position,
            hold,
            entry: hold,
            landings: 0,
            contact: ContactPoint::new(position, hold),
            steps: 0,
            rescues: 0,
        };
        proxy.restart(body, position);
        proxy
    }

    /// Lifts the proxy off and sets it down at `position` without a sweep between.
    ///
    /// The body may be another one than before.
    pub fn restart(&mut self, body: &Body, position: DVec3) {
        // What was held may not exist any more.
        self.hold.triangle = 0;
        self.position = position;
        self.contact.lift(position);
        let (distance, inside) = self.look(body, position);
        self.place = if inside || self.is_in_other_part(body, position, distance) {
            Place::Buried {
                clearance: distance,
            }
        } else {
            Place::Free {
                clearance: distance,
                blind: 0,
            }
        };
    }

    /// Contact point, m; the device itself while free.
    #[inline]
    pub fn position(&self) -> DVec3 {
        self.contact.position
    }

    /// The contact that makes the force, if there is one.
    #[inline]
    pub fn hold(&self) -> Option<SurfacePoint> {
        self.god_hold().map(|_| self.contact.hold)
    }

    /// The god object, m: where the contact point would be at once, without shading and friction.
    #[inline]
    pub fn god_object(&self) -> DVec3 {
        self.position
    }

    /// The place on the surface that it touches, or was nearest to when that was last asked for.
    #[inline]
    pub fn nearest(&self) -> SurfacePoint {
        self.god_hold().map_or(self.hold, |_| self.contact.hold)
    }

    /// Whether it was set down inside of the body and was not outside since.
    pub fn is_buried(&self) -> bool {
        matches!(self.place, Place::Buried { .. })
    }

    /// Place on the surface that the god object touches, if it does.
    #[inline]
    pub fn god_hold(&self) -> Option<SurfacePoint> {
        match self.place {
            Place::Free { .. } | Place::Buried { .. } => None,
            _ => Some(self.hold),
        }
    }

    /// The direction nearest to `towards` among the outward normals of the surface at the contact point.
    pub fn normal(&self, body: &Body, feel: &Feel, towards: DVec3) -> DVec3 {
        nearest_normal(body, self.contact.hold, feel.shading, towards)
    }

    /// Whether friction holds the contact point where it is.
    #[inline]
    pub fn is_sticking(&self) -> bool {
        self.contact.friction.sticking
    }

    /// Features visited in the last tick.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Number of sweeps that the sign of the distance had to correct.
    pub fn rescues(&self) -> u64 {
        self.rescues
    }

    /// Follows the device to `device`, which must be finite, in a tick of `dt` seconds.
    pub fn follow(&mut self, body: &Body, device: DVec3, feel: &Feel, dt: f64) {
        self.drag(body, device);
        match self.god_hold() {
            Some(hold) => {
                let god = Judged {
                    hold,
                    position: self.position,
                    entry: self.entry,
                    landings: self.landings,
                };
                self.contact.follow(body, &god, device, feel, dt);
            }
            None => self.contact.lift(device),
        }
    }

    /// Comes from free space onto the surface at `self.hold`.
    pub(super) fn enter(&mut self, body: &Body) {
        self.land(body);
        self.entry = self.hold;
        self.landings += 1;
    }

    /// Takes hold of the surface at `self.hold`.
    pub(super) fn land(&mut self, body: &Body) {
        self.hold.alpha = snap(self.hold.alpha);
        self.place = Place::of(self.hold);
        self.position = body.face(self.hold.triangle).at(self.hold.alpha);
    }
}
