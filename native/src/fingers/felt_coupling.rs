//! How much of the corrected force fingers get that hold each other through the body;
//! `docs/large-deformation.md` has the formulas.

use glam::DMat3;

use crate::body::softening::{Relation, Softening};
use crate::contact::cones::{Blocks, MAX_FINGERS, Members};
use crate::fingers::press::numbered;

/// Couplings between which the share of the correction goes from all to nothing.
const WEAK: f64 = 0.35;
const STRONG: f64 = 0.65;
/// Weight of all directions beside that of b, in parts of w.
const SIDEWAYS: f64 = 0.05;

/// How others that are coupled to a finger change its relation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// Of the softening, 0 to 1.
    pub share: f64,
    /// Least saturation, in parts of k b.C b.
    pub firmness: f64,
}

impl Held {
    /// At a coupling.
    pub fn at(coupling: f64) -> Self {
        let x = ((STRONG - coupling) / (STRONG - WEAK)).clamp(0.0, 1.0);
        Self {
            share: x * x * (3.0 - 2.0 * x),
            firmness: firmness(coupling.min(STRONG)),
        }
    }

    /// The relation of a finger that is held so, at a place of this `compliance`.
    pub fn relation(&self, alone: &Relation, compliance: &DMat3) -> Relation {
        let slope = alone.softening.slope * self.share;
        let yielding = slope.dot(*compliance * slope);
        let least = alone.mean_stiffness() * yielding * self.firmness;
        Relation {
            stiffness: alone.stiffness,
            softening: Softening {
                slope,
                saturation: (alone.softening.saturation * self.share).max(least),
            },
        }
    }
}

/// Along b no tangent exceeds m^(-1/2) times that at rest.
fn firmness(coupling: f64) -> f64 {
    let root = coupling.cbrt();
    root / (1.0 - root)
}

/// How strongly each finger is coupled to all others, in the direction in which its place softens.
pub fn couplings(
    compliance: &Blocks,
    members: &Members,
    relations: &[Option<Relation>; MAX_FINGERS],
) -> [f64; MAX_FINGERS] {
    let mut total = [0.0; MAX_FINGERS];
    for (p, own) in numbered(relations) {
        let b = own.softening.slope;
        let sideways = SIDEWAYS * own.softening.saturation / own.mean_stiffness();
        let alone = b.dot(compliance[p][p] * b) + 3.0 * sideways;
        if alone <= 0.0 {
            continue;
        }
        for q in members.numbers().filter(|&q| q != p) {
            let Some(other) = &relations[q] else { continue };
            let back = compliance[p][q] * other.stiffness * compliance[q][p];
            let all = own.stiffness * back;
            let trace = all.x_axis.x + all.y_axis.y + all.z_axis.z;
            let by_other = b.dot(back * b) + sideways * trace;
            total[p] += (by_other.max(0.0) / alone).sqrt();
        }
    }
    total
}
