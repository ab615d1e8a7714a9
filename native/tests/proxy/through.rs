//! Straight pushes through a thin part into the air behind it, and where they end.
#![allow(dead_code)] // Each test file takes what it needs.

use glam::DVec3;
use palpate_servo::body::surface::Body;
use palpate_servo::proxy::{Feel, Proxy};

use crate::bodies::Dice;
use crate::pushing::winding;

/// Ticks at the end of a push, in which the contact point comes to rest.
const REST: usize = 20;

/// A push that ends in the air behind a thin part.
#[derive(Debug, Clone, Copy)]
pub struct Through {
    pub from: DVec3,
    pub to: DVec3,
    /// Where it meets the surface, and the normal there.
    pub place: DVec3,
    pub normal: DVec3,
    pub steps: usize,
}

/// Where the finger is held at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// Before the part, or on its rim, still pushing it.
    InFront,
    /// In the air, on the other side: it went round a rim.
    SlippedOff,
}

impl Through {
    /// A push of any slant and speed through a part less thick than this share of the body's size;
    /// none where there is no such part, or no air.
    pub fn random(body: &Body, dice: &mut Dice, thickest: f64) -> Option<Self> {
        let size = body.size();
        let face = body.face(dice.below(body.triangles.len()) as u32);
        let shares = [dice.unit(), dice.unit(), dice.unit()];
        let sum: f64 = shares.iter().sum();
        let place = face.at(shares.map(|share| share / sum));
        let way = (dice.direction() * (1.5 * dice.unit()) - face.normal).normalize();
        if way.dot(face.normal) > -0.1 {
            return None;
        }
        let below = place + way * (1e-7 * size);
        let (tree, nothing) = (body.tree(), []);
        let leaving = tree
            .sweep(body, below, below + way * (thickest * size), &nothing)
            .leaving?;
        let thick = leaving.fraction * thickest * size;
        let from = place - way * (0.02 * size * dice.within(0.05, 1.0));
        let to = place + way * (thick * dice.within(1.05, 8.0));
        let first = tree.sweep(body, from, to, &nothing).entering?;
        let meets = from.lerp(to, first.fraction).distance(place) < 1e-6 * size;
        if !meets || winding(body, from) > 0.5 || winding(body, to) > 0.5 {
            return None;
        }
        // From a tenth of a millimetre a tick on a body of 100 mm to a leap over all of it.
        let speed = 1e-3 * size * 10.0_f64.powf(dice.within(-1.0, 2.0));
        let steps = (from.distance(to) / speed).ceil() as usize;
        Some(Self {
            from,
            to,
            place,
            normal: face.normal,
            steps: steps.max(1),
        })
    }

    /// The end of the push when it is made in so many ticks.
    pub fn end(&self, body: &Body, steps: usize, feel: &Feel) -> Ended {
        let mut proxy = Proxy::new(body, self.from);
        for step in (1..=steps).chain(std::iter::repeat_n(steps, REST)) {
            let device = self.from.lerp(self.to, step as f64 / steps as f64);
            proxy.follow(body, device, feel, 1e-3);
        }
        if proxy.hold().is_some() {
            Ended::InFront
        } else {
            Ended::SlippedOff
        }
    }

    /// Whether pushes beside it end otherwise: then a hair decides.
    pub fn is_on_edge(&self, body: &Body) -> bool {
        let aside = self.normal.any_orthonormal_vector() * (1e-4 * body.size());
        let other = self.normal.cross(aside);
        let beside = [aside, -aside, other, -other].map(|by| {
            let push = Self {
                from: self.from + by,
                to: self.to + by,
                ..*self
            };
            push.end(body, 10 * self.steps, &Feel::default())
        });
        beside.iter().any(|end| *end != beside[0])
    }
}
