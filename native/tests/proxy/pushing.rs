//! Quantised pushes into a body and out again, and who judges them.
#![allow(dead_code)] // Each test file takes what it needs.

use glam::DVec3;
use palpate_servo::body::closest::closest_point;
use palpate_servo::body::surface::Body;
use palpate_servo::proxy::{Feel, Proxy};

use crate::bodies::Dice;

/// Steps of device positions, m.
pub const QUANTA: [f64; 5] = [1e-6, 10e-6, 20e-6, 50e-6, 60e-6];

/// Winding number of the surface about `p`: 1 inside, 0 outside (van Oosterom and Strackee 1983).
/// A referee that shares no code with the crate.
pub fn winding(body: &Body, p: DVec3) -> f64 {
    let mut sum = 0.0;
    for triangle in &body.triangles {
        let [a, b, c] = triangle.map(|n| body.nodes[n as usize] - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        sum += 2.0 * a.dot(b.cross(c)).atan2(below);
    }
    sum / (4.0 * std::f64::consts::PI)
}

/// Nearest point of one triangle to `p` by projecting and clamping, as a referee.
pub fn nearest_on(corners: [DVec3; 3], p: DVec3) -> DVec3 {
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a);
    let q = p - n * (n.dot(p - a) / n.length_squared());
    let is_in = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(s, e)| n.cross(e - s).dot(q - s) >= 0.0);
    if is_in {
        return q;
    }
    [(a, b), (b, c), (c, a)]
        .map(|(s, e)| {
            let t = ((p - s).dot(e - s) / (e - s).length_squared()).clamp(0.0, 1.0);
            s + (e - s) * t
        })
        .into_iter()
        .min_by(|x, y| x.distance(p).total_cmp(&y.distance(p)))
        .unwrap()
}

pub fn distance_to_surface(body: &Body, p: DVec3) -> f64 {
    body.triangles
        .iter()
        .map(|t| nearest_on(t.map(|n| body.nodes[n as usize]), p).distance(p))
        .fold(f64::INFINITY, f64::min)
}

pub fn quantised(p: DVec3, quantum: f64) -> DVec3 {
    (p / quantum).round() * quantum
}

/// A place on the surface: in a triangle, on an edge, or a node; and the normal there.
pub fn target(body: &Body, dice: &mut Dice) -> (DVec3, DVec3) {
    let t = dice.below(body.triangles.len()) as u32;
    let face = body.face(t);
    let mut alpha = [dice.unit(), dice.unit(), dice.unit()];
    let zeros = dice.below(3);
    let first = dice.below(3);
    for k in 0..zeros {
        alpha[(first + k) % 3] = 0.0;
    }
    let sum: f64 = alpha.iter().sum();
    (face.at(alpha.map(|a| a / sum)), face.normal)
}

/// The device's way in one push: in along `inwards` and out again, quantised.
pub struct Push {
    from: DVec3,
    inwards: DVec3,
    quantum: f64,
    steps: usize,
    length: f64,
}

/// How a push ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// It did not begin outside: no push.
    Inside,
    /// It never touched: it passed a corner, or the quantum is coarser than the body.
    Missed,
    Held,
    FellThrough(DVec3),
    Stuck(DVec3),
    /// The contact point is where no force may come from.
    Astray(DVec3),
}

impl Push {
    pub fn random(body: &Body, dice: &mut Dice, number: usize, quantum: f64) -> Self {
        let (goal, normal) = target(body, dice);
        // Every kind of direction: the normal, an axis, a diagonal, anything.
        let inwards = match number % 4 {
            0 => -normal,
            1 => {
                let axis = normal.abs().max_position();
                let mut d = DVec3::ZERO;
                d[axis] = -normal[axis].signum();
                d
            }
            2 => (-normal.signum()).normalize(),
            _ => {
                let d = dice.direction();
                if d.dot(normal) > 0.0 { -d } else { d }
            }
        };
        // As deep as 9 mm into the paper's cube.
        let length = 0.1 * body.size();
        // Half of the goals stay exactly where they are, on planes, edges and nodes.
        let goal = if number % 2 == 0 {
            quantised(goal, quantum)
        } else {
            goal
        };
        Self {
            from: goal - inwards * (0.45 * length),
            inwards,
            quantum,
            steps: 20 + dice.below(120),
            length,
        }
    }

    pub fn at(&self, step: usize) -> DVec3 {
        let part = step as f64 / self.steps as f64;
        quantised(
            self.from + self.inwards * (self.length * part),
            self.quantum,
        )
    }

    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Pushes in and out and judges. `look` sees the proxy after each tick that touches.
    pub fn judge(
        &self,
        body: &Body,
        feel: &Feel,
        mut look: impl FnMut(&Proxy, DVec3, usize),
    ) -> Outcome {
        let start = self.at(0);
        if closest_point(body, start, 0).1 {
            return Outcome::Inside;
        }
        let rounding = 1e-11 * body.size();
        // Area coordinates in triangles a nanometre high are that much coarser.
        let on_slivers = 1e-9 * body.size();
        let mut proxy = Proxy::new(body, start);
        let mut landings = 0;
        let mut held_in_front = false;
        let there_and_back = (0..=self.steps).chain((0..=self.steps).rev());
        for (count, step) in there_and_back.enumerate() {
            let device = self.at(step);
            let was_free = proxy.hold().is_none();
            proxy.follow(body, device, feel, 1e-3);
            if let Some(hold) = proxy.hold() {
                landings += usize::from(was_free);
                held_in_front |= count == self.steps;
                look(&proxy, device, step);
                let depth = proxy.god_object().distance(device);
                let arm = device - proxy.position();
                let is_behind = body.face(hold.triangle).normal.dot(arm) <= on_slivers;
                // Bounded by the depth, so that nothing pulls when nothing touches.
                let is_bounded =
                    arm.length() <= depth * (2.0 + 4.0 * feel.static_friction) + on_slivers;
                if !is_behind || !is_bounded {
                    return Outcome::Astray(device);
                }
            } else {
                let (closest, inside) = closest_point(body, device, 0);
                if inside && closest.distance > rounding {
                    return Outcome::FellThrough(device);
                }
                if proxy.position() != device {
                    return Outcome::Astray(device);
                }
            }
        }
        // Whoever went round or through free space comes back from behind and is held there.
        if proxy.hold().is_some() && landings == 1 && held_in_front && sticks(body, &proxy, start) {
            return Outcome::Stuck(start);
        }
        if landings == 0 {
            Outcome::Missed
        } else {
            Outcome::Held
        }
    }
}

/// A proxy may hold on only if the way to the device leads into the body at once.
pub fn sticks(body: &Body, proxy: &Proxy, device: DVec3) -> bool {
    let way = device - proxy.god_object();
    let small = 1e-11 * body.size();
    if way.length() < small {
        return false; // The device is on the surface: holding and free are the same.
    }
    let a_bit_on = proxy.god_object() + way * (2e-5 * body.size() / way.length()).min(0.5);
    if distance_to_surface(body, a_bit_on) < small {
        return false; // The way runs in the surface: no referee can tell its sides apart.
    }
    winding(body, a_bit_on) < 0.5
}
