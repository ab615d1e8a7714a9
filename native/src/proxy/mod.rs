//! The god object: a point that the device drags along but that never enters the rest surface.
//!
//! Free, the proxy is the device, and sweeps decide by exact signs where it meets the surface.
//! Touching, the proxy is held *combinatorially* on a triangle, an edge or a node and walks to the
//! point of the surface that is locally nearest to the device. Around the proxy the surface is a
//! cone; the nearest feature of that cone to the device tells both the way down and, by its
//! pseudonormal, whether the device is on the free side. Signs decide, not distances; the few
//! tolerances below only name what rounding cannot tell apart (on an edge, on the surface).
//!
//! The god object judges; the force comes from the contact point that follows it
//! ([`contact_point`]).

mod contact_point;
mod descent;
mod feel;
mod friction;
mod shading;
mod walk;

use glam::DVec3;

use crate::body::closest::{closest_point, coincident_face};
use crate::body::face::HalfEdge;
use crate::body::surface::Body;
use crate::body::sweep::{Feature, Sweep};
use contact_point::{ContactPoint, Judged};
pub use feel::Feel;
use walk::Walk;

/// Releases and landings in one tick at most.
const MAX_ROUNDS: u32 = 16;
/// Parts that may touch in one point and be left there in one tick.
const MOST_PARTS: usize = 4;
/// A start this much behind a surface (relative to the body) counts as inside, not as rounding.
const ROUNDING: f64 = 1e-9;
/// A device no deeper than this (relative to the body) is on the surface: its side is rounding.
const ON_SURFACE: f64 = 1e-13;
/// Area coordinates below this are exact zeros: the proxy then stands *on* the edge or node, and
/// no step of the walk is too short to be told from rounding. It moves along the surface only.
const BORDER: f64 = 1e-12;

/// A distance to the surface is worth its query when it spares the sweeps of so many ticks.
const WORTH_LOOKING: f64 = 4.0;
/// Flights by sweeps alone between two queries.
const BLIND_FLIGHTS: u8 = 8;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// In free space; the surface is farther than `clearance` from the last query point, and for
    /// `blind` more flights sweeps alone may decide.
    Free {
        clearance: f64,
        blind: u8,
    },
    /// Set down inside the body: feels nothing until it was outside once.
    Buried {
        clearance: f64,
    },
    Face {
        triangle: u32,
    },
    /// `part` of the way along a half-edge, strictly between its ends.
    Edge {
        edge: HalfEdge,
        part: f64,
    },
    Corner {
        triangle: u32,
        corner: u8,
    },
}

/// Where the proxy touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Triangle that carries the contact.
    pub triangle: u32,
    /// Area coordinates; exact zeros on edges and nodes.
    pub alpha: [f64; 3],
}

/// The god object and the contact point that follows it.
#[derive(Debug, Clone)]
pub struct Proxy {
    place: Place,
    position: DVec3,
    queried: DVec3,
    hold: Hold,
    entry: Hold,
    landings: u64,
    contact: ContactPoint,
    steps: u32,
    rescues: u64,
}

impl Proxy {
    /// A proxy that was set down at `position`.
    pub fn new(body: &Body, position: DVec3) -> Self {
        let hold = Hold {
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
    pub fn hold(&self) -> Option<Hold> {
        self.god_hold().map(|_| self.contact.hold)
    }

    /// The god object, m: where the contact point would be at once, without shading and friction.
    #[inline]
    pub fn god_object(&self) -> DVec3 {
        self.position
    }

    /// The place on the surface that it touches, or was nearest to when that was last asked for.
    #[inline]
    pub fn nearest(&self) -> Hold {
        self.god_hold().map_or(self.hold, |_| self.contact.hold)
    }

    /// Whether it was set down inside of the body and was not outside since.
    pub fn is_buried(&self) -> bool {
        matches!(self.place, Place::Buried { .. })
    }

    /// Where the god object touches, if it does.
    #[inline]
    pub fn god_hold(&self) -> Option<Hold> {
        match self.place {
            Place::Free { .. } | Place::Buried { .. } => None,
            _ => Some(self.hold),
        }
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

    /// How often the sign of the distance had to correct a sweep.
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

    /// Moves the god object.
    fn drag(&mut self, body: &Body, device: DVec3) {
        self.steps = 0;
        // Parts that touch where the proxy is may each have been left here: each says that the way
        // leads away from it, so all of them together let go.
        let mut left = [Feature::NONE; MOST_PARTS];
        let mut count = 0;
        let mut left_at = self.position;
        for _ in 0..MAX_ROUNDS {
            match self.place {
                Place::Free { clearance, blind } => {
                    if self.is_clear(device, clearance) {
                        self.position = device;
                        return;
                    }
                    if self.fly(body, device, &[], blind) {
                        return;
                    }
                }
                Place::Buried { clearance } => {
                    self.position = device;
                    if !self.is_clear(device, clearance) {
                        self.restart(body, device);
                    }
                    return;
                }
                _ => match self.walk(body, device) {
                    Walk::Rested => return,
                    Walk::Released(feature) => {
                        if self.position.distance(left_at) > ON_SURFACE * body.size() {
                            (left_at, count) = (self.position, 0);
                        }
                        count = (count + 1).min(MOST_PARTS);
                        left[count - 1] = feature;
                        if self.fly(body, device, &left[..count], 0) {
                            return;
                        }
                    }
                },
            }
        }
    }

    /// Whether `device` lies in the ball around the last query point that holds no surface.
    #[inline]
    fn is_clear(&self, device: DVec3, clearance: f64) -> bool {
        // The shave covers the rounding of both distances; it only costs a query.
        device.distance(self.queried) < clearance * (1.0 - 1e-9)
    }

    /// Distance to the surface and whether `p` is inside; remembers the nearest triangle.
    fn look(&mut self, body: &Body, p: DVec3) -> (f64, bool) {
        let (closest, inside) = closest_point(body, p, self.hold.triangle);
        self.queried = p;
        self.hold = Hold {
            triangle: closest.triangle,
            alpha: closest.alpha,
        };
        (closest.distance, inside)
    }

    /// Whether `p`, outside of the part it is nearest to, is inside of one that coincides there;
    /// remembers its triangle.
    fn is_in_other_part(&mut self, body: &Body, p: DVec3, distance: f64) -> bool {
        let rounding = ON_SURFACE * body.size();
        if distance <= rounding {
            return false;
        }
        let found = coincident_face(body, p, distance, rounding);
        if let Some(closest) = found {
            self.hold = Hold {
                triangle: closest.triangle,
                alpha: closest.alpha,
            };
        }
        found.is_some()
    }

    /// Moves through free space to the device; false when it landed on the surface.
    ///
    /// From a place that is outside for certain the sweep's signs are proof enough, so near the
    /// surface, where the distance to it spares no sweeps, it is asked for now and then only.
    fn fly(&mut self, body: &Body, device: DVec3, left: &[Feature], blind: u8) -> bool {
        let start = self.position;
        let Sweep { entering, leaving } = body.tree().sweep(body, start, device, left);
        let leaves_first = leaving.filter(|l| entering.is_none_or(|e| l.fraction < e.fraction));
        let inside_already = leaves_first.is_some_and(|l| {
            // A way that grazes an edge seems to leave too; but it never was inside.
            let before = start.lerp(device, 0.5 * l.fraction);
            let (closest, inside) = closest_point(body, before, l.triangle);
            inside && closest.distance > ROUNDING * body.size()
        });
        if inside_already {
            // A start exactly on the surface, rounded to its inner side, in front of a thin wall.
            self.look(body, start);
            self.rescues += 1;
            self.enter(body);
            return false;
        }
        if let Some(crossing) = entering {
            self.hold = Hold {
                triangle: crossing.triangle,
                alpha: crossing.alpha,
            };
            self.enter(body);
            return false;
        }
        if blind > 0 && leaves_first.is_none() {
            self.position = device;
            self.place = Place::Free {
                clearance: 0.0,
                blind: blind - 1,
            };
            return true;
        }
        let (clearance, inside) = self.look(body, device);
        // Only a way that began on the surface can have entered a part without a crossing.
        let inside = inside
            || (clearance * (1.0 - ROUNDING) <= start.distance(device)
                && self.is_in_other_part(body, device, clearance));
        if inside && clearance > ON_SURFACE * body.size() {
            self.rescues += 1;
            self.enter(body);
            return false;
        }
        self.position = device;
        // A device that is on the surface within rounding is free; the next sweep starts there.
        let clearance = if inside { 0.0 } else { clearance };
        let is_certain = clearance > ROUNDING * body.size();
        let spares_sweeps = clearance > WORTH_LOOKING * start.distance(device);
        self.place = Place::Free {
            clearance,
            blind: if is_certain && !spares_sweeps {
                BLIND_FLIGHTS
            } else {
                0
            },
        };
        true
    }

    /// Comes from free space onto the surface at `self.hold`.
    fn enter(&mut self, body: &Body) {
        self.land(body);
        self.entry = self.hold;
        self.landings += 1;
    }

    /// Takes hold of the surface at `self.hold`.
    fn land(&mut self, body: &Body) {
        let Hold { triangle, alpha } = self.hold;
        let alpha = snap(alpha);
        self.hold.alpha = alpha;
        self.place = match alpha.map(|a| a == 0.0) {
            [false, true, true] => Place::Corner {
                triangle,
                corner: 0,
            },
            [true, false, true] => Place::Corner {
                triangle,
                corner: 1,
            },
            [true, true, false] => Place::Corner {
                triangle,
                corner: 2,
            },
            [false, false, true] => on_edge(triangle, 0, alpha[1]),
            [true, false, false] => on_edge(triangle, 1, alpha[2]),
            [false, true, false] => on_edge(triangle, 2, alpha[0]),
            _ => Place::Face { triangle },
        };
        self.position = body.face(triangle).at(alpha);
    }
}

fn snap(alpha: [f64; 3]) -> [f64; 3] {
    let alpha = alpha.map(|a| if a < BORDER { 0.0 } else { a });
    let sum = alpha[0] + alpha[1] + alpha[2];
    alpha.map(|a| a / sum)
}

fn on_edge(triangle: u32, edge: u8, part: f64) -> Place {
    Place::Edge {
        edge: HalfEdge { triangle, edge },
        part,
    }
}
