//! Rotation-strain coordinates: a linear displacement, bent and twisted by the rotations it means.
//!
//! In every domain the gradient of a linear displacement falls into a strain e and a small rotation w.
//! Taken as what they stand for, a stretch U and a finite rotation, they ask for the deformation gradient
//! F = exp(\[w\]x) U; where that does not fit together, the displacement whose gradients come nearest is
//! taken, a Poisson equation with the pins held (J. Huang and others, Interactive Shape Interpolation
//! through Controllable Dynamic Deformation, IEEE TVCG 17, 2011, section 3).
//!
//! For the stretch they take U = I + e. Here it is U = e + 3 I - 2 (I + e^2 / 4)^-1, which agrees with
//! e + (I + e^2)^(1/2) to the fourth order. There U - U^-1 is 2 e, so that the stress of a neo-Hookean
//! solid is the one that the linear computation found, and its volume exp(tr e) as nearly. It grows with
//! e everywhere, and nothing is inside out that is not pressed to e = -2.

use super::domains::{Domains, Nodal};
use super::factor;
use super::factor::Factor;
use super::four::{
    Four, Matrix, axial, cross_matrix, inverse_above_identity, on_diagonal, plus, product, scaled,
    symmetric_part, transposed,
};
use super::strained::Springs;
use super::turns::Turns;
use crate::algebra::wide::widely;

/// The map, for some domains.
#[derive(Debug, Clone)]
pub struct Warp {
    /// What each domain counts where gradients do not fit together.
    weights: Vec<Four>,
    poisson: Factor<f64>,
}

/// Room for the map's solves.
#[derive(Debug, Clone)]
pub struct Room {
    right: Vec<[f64; 3]>,
    poisson: factor::Room<Four>,
}

impl Warp {
    /// Domains count by `weights`, volume times stiffness: what does not fit together then strains what
    /// is soft, and bone stays bone. `poisson` is the factor of the sum of weights times gradients'
    /// squares, and of the springs.
    pub fn new(weights: Vec<Four>, poisson: Factor<f64>) -> Self {
        Self { weights, poisson }
    }

    /// Room for it.
    pub fn room(&self) -> Room {
        Room {
            right: vec![[0.0; 3]; self.poisson.len()],
            poisson: self.poisson.room(),
        }
    }

    /// Warps a linear displacement of the nodes; `gradients` keeps its own in the domains.
    pub fn warp(
        &self,
        (domains, springs): (&Domains, Option<&Springs>),
        linear: &Nodal,
        gradients: &mut [Matrix],
        room: &mut Room,
        warped: &mut Nodal,
    ) {
        room.right.fill([0.0; 3]);
        ask(domains, &self.weights, linear, gradients, &mut room.right);
        if let Some(springs) = springs {
            springs.add_forces(linear, &mut room.right);
        }
        self.poisson
            .solve_axes(&room.right, &mut room.poisson, warped);
    }

    /// The transposed derivative of the map where it was last taken, on nodal forces: their work on any
    /// change of the warped displacements is that of `pulled` on the change of the linear ones.
    pub fn pull_back(
        &self,
        (domains, springs): (&Domains, Option<&Springs>),
        gradients: &[Matrix],
        forces: &Nodal,
        room: &mut Room,
        pulled: &mut Nodal,
    ) {
        self.poisson
            .solve_axes(forces, &mut room.poisson, &mut room.right);
        pulled.fill([0.0; 3]);
        answer(domains, &self.weights, gradients, &room.right, pulled);
        if let Some(springs) = springs {
            springs.add_forces(&room.right, pulled);
        }
    }
}

/// (I + e^2 / 4)^-1 and e^2 / 4.
#[inline(always)]
fn bounded(e: &Matrix) -> (Matrix, Matrix) {
    let squared = scaled(&product(e, e), Four::all(0.25));
    let inverse = inverse_above_identity(&on_diagonal(&squared, Four::all(1.0)));
    (inverse, squared)
}

/// The rotations that a linear displacement's gradients mean.
#[inline(always)]
fn turns_of(gradient: &Matrix) -> Turns {
    let (twice, half) = (axial(gradient), Four::all(0.5));
    Turns::of([twice[0] * half, twice[1] * half, twice[2] * half])
}

widely! {
    /// Adds the nodal forces of F - I, for each domain what it asks for.
    fn ask(
        domains: &Domains,
        weights: &[Four],
        linear: &Nodal,
        gradients: &mut [Matrix],
        right: &mut Nodal,
    ) {
        for four in 0..domains.fours() {
            let gradient = domains.gradient(four, linear);
            gradients[four] = gradient;
            let turns = turns_of(&gradient);
            let strain = symmetric_part(&gradient);
            let (inverse, squared) = bounded(&strain);
            // I - (I + q)^-1 = q (I + q)^-1: what is small is never added to the identity.
            let stretch = plus(&strain, &scaled(&product(&squared, &inverse), Four::all(2.0)));
            let rotated = turns.less_identity();
            let wanted = plus(&plus(&product(&rotated, &stretch), &rotated), &stretch);
            domains.add_forces(four, &scaled(&wanted, weights[four]), right);
        }
    }
}

widely! {
    /// Adds what each domain pulls back.
    fn answer(
        domains: &Domains,
        weights: &[Four],
        gradients: &[Matrix],
        solved: &Nodal,
        pulled: &mut Nodal,
    ) {
        for four in 0..domains.fours() {
            let gradient = &gradients[four];
            let turns = turns_of(gradient);
            let e = symmetric_part(gradient);
            let (inverse, _) = bounded(&e);
            let stress = scaled(&domains.gradient(four, solved), weights[four]);
            let rotation = on_diagonal(&turns.less_identity(), Four::all(1.0));
            let local = product(&transposed(&rotation), &stress);
            // The work R' stress does on a turn, [a]x U, with a = J dw ...
            let stretch = plus(&e, &scaled(&inverse, Four::all(-2.0)));
            let stretch = on_diagonal(&stretch, Four::all(3.0));
            let moments = turns.pulled_back(&axial(&product(&local, &stretch)));
            // ... and on dU = de + S (de e + e de) S / 2, S the bounded part.
            let local = symmetric_part(&local);
            let inner = product(&product(&inverse, &local), &inverse);
            let strained = plus(&local, &symmetric_part(&product(&e, &inner)));
            let spun = scaled(&cross_matrix(&moments), Four::all(0.5));
            domains.add_forces(four, &plus(&strained, &spun), pulled);
        }
    }
}
