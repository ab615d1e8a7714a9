//! The strain energy of a body on its nodes, and its forces.

use super::domains::{Domains, Nodal};
use super::four::Four;
use super::law::Law;
use super::springs::Springs;
use crate::algebra::wide::widely;

/// A part of the strain energy: its domains, and their moduli times their volumes.
#[derive(Debug, Clone)]
pub struct Term {
    /// Where it is taken.
    pub domains: Domains,
    /// Lame's first parameter and shear modulus times volume.
    pub moduli: Vec<(Four, Four)>,
}

/// A body of some law on its free nodes, and springs if it has any.
#[derive(Debug, Clone)]
pub struct Strained {
    /// The energy is their sum.
    pub terms: Vec<Term>,
    /// Of the material.
    pub law: Law,
    /// Beside the strains.
    pub springs: Option<Springs>,
}

impl Strained {
    /// The energy at displacements, J; `forces` become those that hold the nodes there, its gradient.
    pub fn energy_and_forces(&self, moved: &Nodal, forces: &mut Nodal) -> f64 {
        forces.fill([0.0; 3]);
        let mut energy = 0.0;
        for term in &self.terms {
            energy += stressed(term, self.law, moved, forces);
        }
        if let Some(springs) = &self.springs {
            springs.add_forces(moved, forces);
            energy += springs.energy(moved);
        }
        energy
    }
}

widely! {
    /// The energy of a term; adds its forces.
    fn stressed(term: &Term, law: Law, moved: &Nodal, forces: &mut Nodal) -> f64 {
        let mut energy = Four::default();
        for four in 0..term.domains.fours() {
            let (first_lame, shear) = term.moduli[four];
            let gradient = term.domains.gradient(four, moved);
            let (density, stress) = law.stressed(&gradient, first_lame, shear);
            energy += density;
            term.domains.add_forces(four, &stress, forces);
        }
        energy.sum()
    }
}
