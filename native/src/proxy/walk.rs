//! The walk on the surface to the point locally nearest to the device.

use glam::DVec3;

use crate::body::face::HalfEdge;
use crate::body::surface::Body;
use crate::body::sweep::Feature;
use crate::proxy::god_object::Proxy;
use crate::proxy::place::{BORDER, Place, SurfacePoint, snap};

/// Features visited in one tick at most; a tick that ends here goes on in the next one.
const MAX_STEPS: u32 = 512;

/// Outcome of the walk on the surface.
pub(super) enum Walk {
    Rested,
    Released(Feature),
}

/// Condition on a step of the walk.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    /// The distance to the device must fall in floating point. Every step onto a feature with a
    /// larger border is of this kind, so the walk cannot go round in circles.
    Down,
    /// From a triangle to its edge or from an edge to its end, however near that is.
    Any,
}

impl Proxy {
    /// Walks down to the surface point locally nearest to the device.
    pub(super) fn walk(&mut self, body: &Body, device: DVec3) -> Walk {
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
            self.hold = SurfacePoint {
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
        self.hold = SurfacePoint { triangle, alpha };
        self.land(body);
        true
    }
}

fn edge_alpha(edge: usize, part: f64) -> [f64; 3] {
    let mut alpha = [0.0; 3];
    alpha[edge] = 1.0 - part;
    alpha[(edge + 1) % 3] = part;
    alpha
}
