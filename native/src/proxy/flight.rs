//! The way of the god object: through free space by sweeps, on the surface by walks.

use glam::DVec3;

use crate::body::closest::{closest_point, coincident_face};
use crate::body::surface::Body;
use crate::body::sweep::{Feature, Sweep};
use crate::proxy::god_object::Proxy;
use crate::proxy::place::{Place, SurfacePoint};
use crate::proxy::walk::Walk;

/// Releases and landings in one tick at most.
const MAX_ROUNDS: u32 = 16;
/// Parts that may touch in one point and be left there in one tick.
const MOST_PARTS: usize = 4;
/// A start this much behind a surface (relative to the body) counts as inside, not as rounding.
const ROUNDING: f64 = 1e-9;
/// A device no deeper than this (relative to the body) is on the surface: its side is rounding.
const ON_SURFACE: f64 = 1e-13;
/// A distance to the surface is worth its query when it spares the sweeps of so many ticks.
const WORTH_LOOKING: f64 = 4.0;
/// Flights by sweeps alone between two queries.
const BLIND_FLIGHTS: u8 = 8;

impl Proxy {
    /// Moves the god object.
    pub(super) fn drag(&mut self, body: &Body, device: DVec3) {
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
    pub(super) fn look(&mut self, body: &Body, p: DVec3) -> (f64, bool) {
        let (closest, inside) = closest_point(body, p, self.hold.triangle);
        self.queried = p;
        self.hold = SurfacePoint {
            triangle: closest.triangle,
            alpha: closest.alpha,
        };
        (closest.distance, inside)
    }

    /// Whether `p`, outside of the part it is nearest to, is inside of one that coincides there;
    /// remembers its triangle.
    pub(super) fn is_in_other_part(&mut self, body: &Body, p: DVec3, distance: f64) -> bool {
        let rounding = ON_SURFACE * body.size();
        if distance <= rounding {
            return false;
        }
        let found = coincident_face(body, p, distance, rounding);
        if let Some(closest) = found {
            self.hold = SurfacePoint {
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
            self.hold = SurfacePoint {
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
}
