//! The god object: a point that the device drags along but that never enters the rest surface.
//!
//! Free, the proxy is the device, and sweeps decide by exact signs where it meets the surface.
//! Touching, the proxy is held *combinatorially* on a triangle, an edge or a node and walks to the
//! point of the surface that is locally nearest to the device. Around the proxy the surface is a
//! cone; the nearest feature of that cone to the device tells both the way down and, by its
//! pseudonormal, whether the device is on the free side. No distance tolerance decides anything,
//! so there is none to fall through.

use glam::DVec3;

use crate::closest::closest_point;
use crate::surface::{Body, HalfEdge};
use crate::tree::{Feature, Sweep};

/// Features visited in one tick at most; a tick that ends here goes on in the next one.
const MAX_STEPS: u32 = 512;
/// Releases and landings in one tick at most.
const MAX_ROUNDS: u32 = 16;
/// A start this much behind a surface (relative to the body) counts as inside, not as rounding.
const ROUNDING: f64 = 1e-9;
/// A device no deeper than this (relative to the body) is on the surface: its side is rounding.
const ON_SURFACE: f64 = 1e-13;
/// Area coordinates below this are exact zeros: the proxy then stands *on* the edge or node, and
/// no step of the walk is too short to be told from rounding. It moves along the surface only.
const BORDER: f64 = 1e-12;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// In free space; the surface is farther than `clearance` from the last query point.
    Free {
        clearance: f64,
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

/// What the walk on the surface came to.
enum Walk {
    Rested,
    Released(Feature),
}

/// Where the proxy touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Triangle that carries the contact.
    pub triangle: u32,
    /// Area coordinates; exact zeros on edges and nodes.
    pub alpha: [f64; 3],
}

/// The god object.
#[derive(Debug, Clone)]
pub struct Proxy {
    place: Place,
    position: DVec3,
    queried: DVec3,
    hold: Hold,
    steps: u32,
    rescues: u64,
}

impl Proxy {
    /// A proxy that was set down at `position`.
    pub fn new(body: &Body, position: DVec3) -> Self {
        let mut proxy = Self {
            place: Place::Free { clearance: 0.0 },
            position,
            queried: position,
            hold: Hold {
                triangle: 0,
                alpha: [1.0, 0.0, 0.0],
            },
            steps: 0,
            rescues: 0,
        };
        proxy.restart(body, position);
        proxy
    }

    /// Lifts the proxy off and sets it down at `position` without a sweep between.
    pub fn restart(&mut self, body: &Body, position: DVec3) {
        self.position = position;
        let (distance, inside) = self.look(body, position);
        self.place = if inside {
            Place::Buried {
                clearance: distance,
            }
        } else {
            Place::Free {
                clearance: distance,
            }
        };
    }

    /// Position, m.
    #[inline]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// The contact, if there is one.
    #[inline]
    pub fn hold(&self) -> Option<Hold> {
        match self.place {
            Place::Free { .. } | Place::Buried { .. } => None,
            _ => Some(self.hold),
        }
    }

    /// Features visited in the last tick.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// How often the sign of the distance had to correct a sweep.
    pub fn rescues(&self) -> u64 {
        self.rescues
    }

    /// Follows the device to `device`, which must be finite.
    pub fn follow(&mut self, body: &Body, device: DVec3) {
        self.steps = 0;
        for _ in 0..MAX_ROUNDS {
            match self.place {
                Place::Free { clearance } => {
                    if self.is_clear(device, clearance) {
                        self.position = device;
                        return;
                    }
                    if self.fly(body, device, &Feature::NONE) {
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
                        if self.fly(body, device, &feature) {
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

    /// Moves through free space to the device; false when it landed on the surface.
    fn fly(&mut self, body: &Body, device: DVec3, left: &Feature) -> bool {
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
            self.land(body);
            return false;
        }
        if let Some(crossing) = entering {
            self.hold = Hold {
                triangle: crossing.triangle,
                alpha: crossing.alpha,
            };
            self.land(body);
            return false;
        }
        let (clearance, inside) = self.look(body, device);
        if inside && clearance > ON_SURFACE * body.size() {
            self.rescues += 1;
            self.land(body);
            return false;
        }
        self.position = device;
        // A device that is on the surface within rounding is free; the next sweep starts there.
        let clearance = if inside { 0.0 } else { clearance };
        self.place = Place::Free { clearance };
        true
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

    /// Walks down to the surface point locally nearest to the device.
    fn walk(&mut self, body: &Body, device: DVec3) -> Walk {
        while self.steps < MAX_STEPS {
            self.steps += 1;
            let went_on = match self.place {
                Place::Face { triangle } => {
                    if body.face(triangle).side(device) > 0.0 {
                        return Walk::Released(Feature::new(&body.triangles[triangle as usize]));
                    }
                    self.cross_face(body, triangle, self.hold.alpha, device, Step::Any)
                }
                Place::Edge { edge, part } => match self.leave_edge(body, edge, part, device) {
                    Ok(went_on) => went_on,
                    Err(released) => return Walk::Released(released),
                },
                Place::Corner { triangle, corner } => {
                    match self.leave_corner(body, triangle, corner, device) {
                        Ok(went_on) => went_on,
                        Err(released) => return Walk::Released(released),
                    }
                }
                Place::Free { .. } | Place::Buried { .. } => false,
            };
            if !went_on {
                return Walk::Rested;
            }
        }
        Walk::Rested
    }

    /// From `alpha` in a triangle towards the device's projection, as far as the border.
    ///
    /// True when it came to the border and must look on from there.
    fn cross_face(
        &mut self,
        body: &Body,
        triangle: u32,
        alpha: [f64; 3],
        device: DVec3,
        step: Step,
    ) -> bool {
        let face = body.face(triangle);
        let goal = face.area_coordinates(device);
        if goal.iter().all(|&g| g > BORDER) {
            self.hold = Hold {
                triangle,
                alpha: goal,
            };
            self.place = Place::Face { triangle };
            self.position = face.at(goal);
            return false;
        }
        let mut part = 1.0;
        let mut side = usize::MAX;
        for k in 0..3 {
            if goal[k] <= BORDER {
                let reached = if goal[k] < 0.0 {
                    alpha[k] / (alpha[k] - goal[k])
                } else {
                    1.0
                };
                if side == usize::MAX || reached < part {
                    (part, side) = (reached, k);
                }
            }
        }
        let mut border = [0, 1, 2].map(|k| (alpha[k] + (goal[k] - alpha[k]) * part).max(0.0));
        border[side] = 0.0;
        let sum: f64 = border.iter().sum();
        let border = border.map(|b| b / sum);
        self.step_to(body, triangle, border, device, step)
    }

    /// From an edge: into a triangle, along the edge, or off the surface.
    fn leave_edge(
        &mut self,
        body: &Body,
        edge: HalfEdge,
        part: f64,
        device: DVec3,
    ) -> Result<bool, Feature> {
        let k = edge.edge as usize;
        let face = body.face(edge.triangle);
        let other = face.across[k];
        let other_face = body.face(other.triangle);
        let arm = device - face.corners[k];
        let down_here = face.inward[k].dot(arm);
        let down_there = other_face.inward[other.edge as usize].dot(arm);
        let release = || {
            let nodes = body.triangles[edge.triangle as usize];
            Feature::new(&[nodes[k], nodes[(k + 1) % 3]])
        };
        if down_here.max(down_there) > 0.0 {
            let (into, its_face, part) = if down_here >= down_there {
                (edge, face, part)
            } else {
                (other, other_face, 1.0 - part)
            };
            if its_face.side(device) > 0.0 {
                return Err(release());
            }
            let alpha = edge_alpha(into.edge as usize, part);
            if self.enters(body, into.triangle, alpha, device) {
                return Ok(self.cross_face(body, into.triangle, alpha, device, Step::Down));
            }
        } else if (face.normal + other_face.normal).dot(arm) > 0.0 {
            return Err(release());
        }
        Ok(self.slide(body, edge, device, Step::Any))
    }

    /// From a node: the steepest way down over its fan, or off the surface.
    fn leave_corner(
        &mut self,
        body: &Body,
        triangle: u32,
        corner: u8,
        device: DVec3,
    ) -> Result<bool, Feature> {
        let (fan, corners) = body.fan(body.face(triangle).fans[corner as usize]);
        let arm = device - body.nodes[fan.node as usize];
        let mut steepest = 0.0;
        let mut way = None;
        let mut steepest_edge = 0.0;
        let mut way_along = None;
        for &step in corners {
            let face = body.face(step.triangle);
            let k = step.corner as usize;
            let along = (face.corners[(k + 1) % 3] - face.corners[k]).normalize();
            let descent = along.dot(arm);
            if descent > steepest_edge {
                (steepest_edge, way_along) = (descent, Some(step));
            }
            if face.inward[k].dot(arm) > 0.0 && face.inward[(k + 2) % 3].dot(arm) > 0.0 {
                let descent = arm.reject_from_normalized(face.normal).length();
                if descent > steepest {
                    (steepest, way) = (descent, Some(step));
                }
            }
        }
        let release = || Feature::new(&[fan.node]);
        if let Some(step) = way
            && steepest >= steepest_edge
        {
            if body.face(step.triangle).side(device) > 0.0 {
                return Err(release());
            }
            let mut alpha = [0.0; 3];
            alpha[step.corner as usize] = 1.0;
            if self.enters(body, step.triangle, alpha, device) {
                return Ok(self.cross_face(body, step.triangle, alpha, device, Step::Down));
            }
        }
        if let Some(step) = way_along {
            let edge = HalfEdge {
                triangle: step.triangle,
                edge: step.corner,
            };
            let face = body.face(step.triangle);
            let other = body.face(face.across[step.corner as usize].triangle);
            if (face.normal + other.normal).dot(arm) > 0.0 {
                return Err(release());
            }
            return Ok(self.slide(body, edge, device, Step::Down));
        }
        if fan.normal.dot(arm) > 0.0 {
            return Err(release());
        }
        Ok(false)
    }

    /// Whether a way from the border of a triangle to the device's projection starts inwards.
    fn enters(&self, body: &Body, triangle: u32, alpha: [f64; 3], device: DVec3) -> bool {
        let goal = body.face(triangle).area_coordinates(device);
        (0..3).all(|k| alpha[k] > 0.0 || goal[k] > 0.0)
    }

    /// Along an edge to the device's projection, as far as its ends; true when at an end.
    fn slide(&mut self, body: &Body, edge: HalfEdge, device: DVec3, step: Step) -> bool {
        let face = body.face(edge.triangle);
        let k = edge.edge as usize;
        let (from, to) = (face.corners[k], face.corners[(k + 1) % 3]);
        let along = to - from;
        let part = along.dot(device - from) / along.length_squared();
        let alpha = snap(edge_alpha(k, part.clamp(0.0, 1.0)));
        let to_end = alpha[k] == 0.0 || alpha[(k + 1) % 3] == 0.0;
        let step = if to_end { step } else { Step::Down };
        self.step_to(body, edge.triangle, alpha, device, step) && to_end
    }

    /// Moves to a place on the border of a triangle; false when it stays where it is.
    fn step_to(
        &mut self,
        body: &Body,
        triangle: u32,
        alpha: [f64; 3],
        device: DVec3,
        step: Step,
    ) -> bool {
        let alpha = snap(alpha);
        let there = body.face(triangle).at(alpha);
        let here = self.position;
        // |device - here|^2 - |device - there|^2 without cancellation.
        let gain = (there - here).dot((device - here) + (device - there));
        if gain <= 0.0 && step == Step::Down {
            return false;
        }
        self.hold = Hold { triangle, alpha };
        self.land(body);
        true
    }
}

/// What a step of the walk must bring.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    /// The distance to the device must fall in floating point. Every step onto a feature with a
    /// larger border is of this kind, so the walk cannot go round in circles.
    Down,
    /// From a triangle to its edge or from an edge to its end, however near that is.
    Any,
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

fn edge_alpha(edge: usize, part: f64) -> [f64; 3] {
    let mut alpha = [0.0; 3];
    alpha[edge] = 1.0 - part;
    alpha[(edge + 1) % 3] = part;
    alpha
}
