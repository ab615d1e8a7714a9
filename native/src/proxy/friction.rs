//! Dry friction: the contact point sticks until the force leaves its cone, then slips along it.
//!
//! The cone is one of forces: |F_t| <= mu F_n for the force that the contact gives (14) in the mode
//! in use, which stiffness in different directions may turn away from the displacement. Within
//! a tangent plane that force is linear in the contact point, so where it re-enters the cone on
//! the way to where nothing pulls sideways any more is solved at once; a few rounds account for
//! the surface that bends on the way. On edges and nodes every normal between the facets' counts.

use glam::{DMat3, DVec3};

use crate::body::face::HalfEdge;
use crate::body::surface::Body;
use crate::contact::touch::contact_stiffness;
use crate::proxy::descent::descend;
use crate::proxy::feel::Feel;
use crate::proxy::place::SurfacePoint;
use crate::proxy::shading::normal_at;

/// Rounds of slipping in one tick.
const MAX_ROUNDS: u32 = 8;
/// Slipping ends this near above the dynamic cone (relative),
const ON_CONE: f64 = 5e-4;
/// as if its coefficient were at least this: no rounding comes to rest on a cone of no width.
const NARROWEST: f64 = 0.01;
/// Without any slip for this long the contact is at rest again, s.
const REST: f64 = 0.02;

/// Whether the contact point sticks, and since when it would.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Friction {
    pub(super) sticking: bool,
    quiet: f64,
}

/// Outcome of a tick of friction.
pub(super) struct Slip {
    pub(super) hold: SurfacePoint,
    /// The contact has just torn loose: its force is meant to drop.
    pub(super) broke_away: bool,
}

/// The finger's pull on the surface per unit modulus, split at the nearest normal.
struct Pull {
    stiffness: DMat3,
    displacement: DVec3,
    normal: DVec3,
    /// Pressing is positive.
    pressing: f64,
    sideways: DVec3,
}

impl Friction {
    /// Next place of the contact point that was at `hold`; None when nothing presses it there.
    pub(super) fn follow(
        &mut self,
        body: &Body,
        hold: SurfacePoint,
        device: DVec3,
        feel: &Feel,
        dt: f64,
    ) -> Option<Slip> {
        let first = Pull::at(body, hold, device, feel)?;
        let ratio = first.ratio();
        let stays = Slip {
            hold,
            broke_away: false,
        };
        let coefficient = feel.dynamic_friction;
        let margin = ON_CONE * coefficient.max(NARROWEST);
        let was_sticking = self.sticking;
        if was_sticking && ratio <= feel.static_friction {
            return Some(stays);
        }
        if ratio <= coefficient + 2.0 * margin {
            self.quiet += dt;
            self.sticking = ratio <= coefficient || self.quiet >= REST;
            return Some(stays);
        }
        (self.sticking, self.quiet) = (false, 0.0);
        let aim = coefficient + margin;
        let (mut from, mut pull, mut excess) = (hold, first, ratio - aim);
        let mut reached = hold;
        let mut part = 1.0;
        for _ in 0..MAX_ROUNDS {
            let start = body.face(from.triangle).at(from.alpha);
            reached = descend(body, from, start + pull.to_cone(aim)? * part);
            let there = Pull::at(body, reached, device, feel)?;
            let excess_there = there.ratio() - aim;
            if excess_there.abs() <= margin {
                break;
            }
            if excess_there > 0.0 {
                (from, pull, excess, part) = (reached, there, excess_there, 1.0);
            } else {
                // Into the cone: where walls meet for good, elsewhere a little less will do.
                part *= excess / (excess - excess_there);
            }
        }
        Some(Slip {
            hold: reached,
            broke_away: was_sticking,
        })
    }
}

impl Pull {
    fn at(body: &Body, hold: SurfacePoint, device: DVec3, feel: &Feel) -> Option<Self> {
        let SurfacePoint { triangle, alpha } = hold;
        let face = body.face(triangle);
        let stiffness = contact_stiffness(body, feel.mode, triangle, alpha);
        let displacement = device - face.at(alpha);
        let force = stiffness * displacement;
        let normal = nearest_normal(body, hold, feel.shading, -force);
        let pressing = -force.dot(normal);
        (pressing > 0.0).then(|| Self {
            stiffness,
            displacement,
            normal,
            pressing,
            sideways: force + normal * pressing,
        })
    }

    fn ratio(&self) -> f64 {
        self.sideways.length() / self.pressing
    }

    /// Way of the contact point in the tangent plane onto the cone.
    fn to_cone(&self, coefficient: f64) -> Option<DVec3> {
        let (x, y) = self.normal.any_orthonormal_pair();
        let (along_x, along_y) = (self.stiffness * x, self.stiffness * y);
        let (xx, xy) = (x.dot(along_x), x.dot(along_y));
        let (yx, yy) = (y.dot(along_x), y.dot(along_y));
        let determinant = xx * yy - xy * yx;
        if determinant <= 0.0 {
            return None;
        }
        let force = self.stiffness * self.displacement;
        let (px, py) = (x.dot(force), y.dot(force));
        let all_the_way = (x * (px * yy - py * xy) + y * (py * xx - px * yx)) / determinant;
        // The way to where nothing pulls sideways: F_t falls linearly to zero, F_n changes by this.
        let pressing_change = self.normal.dot(self.stiffness * all_the_way);
        let sideways = self.sideways.length();
        let denominator = sideways + coefficient * pressing_change;
        let part = if denominator > 0.0 {
            (sideways - coefficient * self.pressing) / denominator
        } else {
            1.0
        };
        let shift = all_the_way * part.clamp(0.0, 1.0);
        shift.is_finite().then_some(shift)
    }
}

/// The direction nearest to `towards` among the normals of the surface at a place.
pub(super) fn nearest_normal(
    body: &Body,
    hold: SurfacePoint,
    shading: bool,
    towards: DVec3,
) -> DVec3 {
    let SurfacePoint { triangle, alpha } = hold;
    let face = body.face(triangle);
    let of = |t: u32, alpha: [f64; 3]| {
        if shading {
            normal_at(body, t, alpha)
        } else {
            body.face(t).normal
        }
    };
    let own = of(triangle, alpha);
    let across = |k: usize| {
        let HalfEdge { triangle, edge } = face.across[k];
        let mut mirrored = [0.0; 3];
        mirrored[edge as usize] = alpha[(k + 1) % 3];
        mirrored[(edge as usize + 1) % 3] = alpha[k];
        nearest_between(own, of(triangle, mirrored), towards)
    };
    match alpha.map(|a| a == 0.0) {
        [false, false, false] => own,
        [false, false, true] => across(0),
        [true, false, false] => across(1),
        [false, true, false] => across(2),
        on_border => {
            let corner = on_border.iter().position(|z| !z).unwrap_or(0);
            let (_, fan) = body.fan(face.fans[corner]);
            let normal = |i: usize| {
                let mut alpha = [0.0; 3];
                alpha[fan[i].corner as usize] = 1.0;
                of(fan[i].triangle, alpha)
            };
            let mut best = own;
            let (mut any_left, mut any_right) = (false, false);
            let mut last = normal(fan.len() - 1);
            for i in 0..fan.len() {
                let next = normal(i);
                let turn = last.cross(next).dot(towards);
                any_left |= turn > 0.0;
                any_right |= turn < 0.0;
                let candidate = nearest_between(last, next, towards);
                if candidate.dot(towards) > best.dot(towards) {
                    best = candidate;
                }
                last = next;
            }
            // Within the cone that all the normals span, every direction is a normal.
            if any_left != any_right && best.dot(towards) > 0.0 {
                return towards.normalize_or(best);
            }
            best
        }
    }
}

/// The unit vector nearest to `towards` on the shorter arc from `a` to `b`.
fn nearest_between(a: DVec3, b: DVec3, towards: DVec3) -> DVec3 {
    let cosine = a.dot(b);
    let (p, q) = (a.dot(towards), b.dot(towards));
    // towards, projected on their plane, as weights of a and b (times 1 - cosine^2).
    let (wa, wb) = (p - cosine * q, q - cosine * p);
    if wa > 0.0 && wb > 0.0 {
        (a * wa + b * wb).normalize_or(a)
    } else if p >= q {
        a
    } else {
        b
    }
}
