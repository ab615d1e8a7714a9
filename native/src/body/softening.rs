//! Softening at large depth: the choices of what is felt, and the softer one's force and tangent.
//!
//! Readable reference: `core/shape/force_at_depth/felt_force.py`, which says why this is convex, and
//! hence continuous, growing and without gain on closed paths, for every softening there may be.

pub mod blend;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use glam::{DMat3, DVec3};

use crate::algebra::series_share;

/// This share of the linear relation stays at any depth: the force never stops growing.
const LEAST_SHARE: f64 = 0.05;
/// A change of what is felt while touching comes in over this time, s.
pub const BLEND_SECONDS: f64 = 0.05;

/// Relation between displacement and force that is felt.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Felt {
    /// The paper's: in proportion, however deep.
    #[default]
    Linear,
    /// That of a solid by its material's law: softer or, as rubber mostly, firmer far in.
    Corrected,
}

impl Felt {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Linear, Self::Corrected];

    /// Name for people and programs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Corrected => "corrected",
        }
    }
}

/// Departure of a place from the linear relation; none by default.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Softening {
    /// b, 1/m: how much softer the place becomes on the way along it.
    pub slope: DVec3,
    /// w, 1/m², not negative: how soon the force saturates.
    pub saturation: f64,
}

impl Softening {
    fn plus(self, other: &Self, share: f64) -> Self {
        Self {
            slope: self.slope + other.slope * share,
            saturation: self.saturation + other.saturation * share,
        }
    }

    /// Mean of three nodes by area coordinates; a node without a part does not matter.
    pub fn mixed(nodes: &[Self; 3], alpha: [f64; 3]) -> Self {
        nodes
            .iter()
            .zip(alpha)
            .fold(Self::default(), |sum, (node, share)| sum.plus(node, share))
    }

    /// Whether the relation is one with it at any displacement.
    pub fn is_sound(&self) -> bool {
        let is_bounded =
            self.saturation > 0.0 || (self.slope == DVec3::ZERO && self.saturation == 0.0);
        is_bounded && self.slope.is_finite() && self.saturation.is_finite()
    }

    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// Energy over k, and S, of a displacement: what all of the relation consists of.
#[derive(Debug, Clone, Copy)]
pub struct Softened {
    energy: f64,
    root: f64,
}

impl Softened {
    /// The numbers for a linear force K u.
    #[inline]
    fn of(linear: DVec3, mean_stiffness: f64, softening: &Softening, u: DVec3) -> Self {
        let twice = linear.dot(u);
        let t = 1.0 + softening.slope.dot(u);
        let root = (t * t + softening.saturation * twice / mean_stiffness).sqrt();
        // Each form loses digits where the other one keeps them.
        let energy = if t > 0.0 {
            twice / (root + t)
        } else {
            mean_stiffness / softening.saturation * (root - t)
        };
        Self { energy, root }
    }

    /// A linear force, softened, of a place with this slope.
    #[inline]
    pub fn force(&self, linear: DVec3, slope: DVec3) -> DVec3 {
        let softened = (linear - slope * self.energy) / self.root;
        linear * LEAST_SHARE + softened * (1.0 - LEAST_SHARE)
    }
}

/// Between the displacement of a contact point and the force that moves it so far.
#[derive(Debug, Clone, Copy)]
pub struct Relation {
    /// K at rest.
    pub stiffness: DMat3,
    /// Departure from that.
    pub softening: Softening,
}

impl Relation {
    /// k.
    pub fn mean_stiffness(&self) -> f64 {
        let k = &self.stiffness;
        (k.x_axis.x + k.y_axis.y + k.z_axis.z) / 3.0
    }

    /// Energy and root at displacement `u`.
    #[inline]
    pub fn softened(&self, u: DVec3) -> Softened {
        let linear = self.stiffness * u;
        Softened::of(linear, self.mean_stiffness(), &self.softening, u)
    }

    /// Force on the body that moves the contact point by `u`.
    #[inline]
    pub fn force(&self, u: DVec3) -> DVec3 {
        let slope = self.softening.slope;
        self.softened(u).force(self.stiffness * u, slope)
    }

    /// Energy of the body with its contact point moved by `u`: its slope is [`force`](Self::force).
    #[inline]
    pub fn energy(&self, u: DVec3) -> f64 {
        let linear = 0.5 * (self.stiffness * u).dot(u);
        linear * LEAST_SHARE + self.softened(u).energy * (1.0 - LEAST_SHARE)
    }

    /// Derivative of [`force`](Self::force): symmetric, positive definite.
    #[inline]
    pub fn tangent(&self, u: DVec3) -> DMat3 {
        let Softening { slope, saturation } = self.softening;
        let linear = self.stiffness * u;
        let Softened { energy, root } = self.softened(u);
        let force = (linear - slope * energy) / root;
        let both = outer(slope, force) + outer(force, slope);
        let curved = outer(force, force) * (saturation / self.mean_stiffness());
        let softened = (self.stiffness - both - curved) * (1.0 / root);
        self.stiffness * LEAST_SHARE + softened * (1.0 - LEAST_SHARE)
    }

    /// Displacement of the body where a spring of this compliance lies between it and a
    /// displacement `u`: v + c f(v) = u, by Newton's method from the linear answer.
    ///
    /// Where the relation softens along the way, every step stays short of the answer and comes
    /// nearer; in any case the steps are bounded, and the energy they look for is convex.
    pub fn behind_spring(&self, compliance: f64, u: DVec3) -> DVec3 {
        let mut v = series_share(&self.stiffness, compliance) * u;
        for _ in 0..MOST_STEPS {
            let missing = u - v - self.force(v) * compliance;
            if missing.abs().max_element() <= CONVERGED * u.abs().max_element() {
                break;
            }
            v += series_share(&self.tangent(v), compliance) * missing;
        }
        v
    }
}

/// Newton steps in one tick; four are enough as a rule.
const MOST_STEPS: usize = 12;
/// Displacements are taken when they miss by this share.
const CONVERGED: f64 = 1e-14;

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// One node's softening, as another thread may still have to find it.
#[derive(Debug, Default)]
struct Entry {
    numbers: [AtomicU64; 4],
    known: AtomicBool,
}

/// Softenings by node, told by one thread at a time while the tick reads: neither waits.
#[derive(Debug)]
pub struct Softenings(Vec<Entry>);

impl Softenings {
    /// None known yet.
    pub fn unknown(nodes: usize) -> Self {
        Self((0..nodes).map(|_| Entry::default()).collect())
    }

    /// Makes a node's known. It belongs to the body and does not change: only the first one counts,
    /// so that no tick reads parts of two.
    pub fn tell(&self, node: u32, softening: &Softening) {
        let entry = &self.0[node as usize];
        if entry.known.load(Ordering::Acquire) {
            return;
        }
        let [x, y, z] = softening.slope.to_array();
        for (place, number) in entry.numbers.iter().zip([x, y, z, softening.saturation]) {
            place.store(number.to_bits(), Ordering::Relaxed);
        }
        entry.known.store(true, Ordering::Release);
    }

    /// A node's, if it is known.
    #[inline]
    pub fn of(&self, node: u32) -> Option<Softening> {
        let entry = &self.0[node as usize];
        entry.known.load(Ordering::Acquire).then(|| {
            let [x, y, z, saturation] = [0, 1, 2, 3]
                .map(|k: usize| f64::from_bits(entry.numbers[k].load(Ordering::Relaxed)));
            Softening {
                slope: DVec3::new(x, y, z),
                saturation,
            }
        })
    }
}
