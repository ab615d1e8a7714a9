//! The strain energy of a body on its nodes, and its forces; springs to their places at rest among them.

use super::domains::{Domains, Nodal};
use super::four::Four;
use super::law::Law;
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
            energy += stressed(term, &self.law, moved, forces);
        }
        if let Some(springs) = &self.springs {
            springs.add_forces(moved, forces);
            energy += springs.energy(moved);
        }
        energy
    }
}

/// The energy u.S u / 2, alike along the three axes, of a sparse symmetric S by rows.
#[derive(Debug, Clone)]
pub struct Springs {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Springs {
    /// S of entries, those of row k from `starts[k]` to `starts[k + 1]`.
    pub fn new(starts: Vec<usize>, columns: Vec<u32>, values: Vec<f64>) -> Self {
        Self {
            starts,
            columns,
            values,
        }
    }

    /// Adds S u to forces.
    pub fn add_forces(&self, moved: &Nodal, forces: &mut Nodal) {
        for (row, force) in forces.iter_mut().enumerate() {
            for at in self.starts[row]..self.starts[row + 1] {
                let (value, from) = (self.values[at], &moved[self.columns[at] as usize]);
                for axis in 0..3 {
                    force[axis] += value * from[axis];
                }
            }
        }
    }

    /// u.S u / 2.
    pub fn energy(&self, moved: &Nodal) -> f64 {
        let mut twice = 0.0;
        for (row, own) in moved.iter().enumerate() {
            for at in self.starts[row]..self.starts[row + 1] {
                let from = &moved[self.columns[at] as usize];
                let product = own[0] * from[0] + own[1] * from[1] + own[2] * from[2];
                twice += self.values[at] * product;
            }
        }
        0.5 * twice
    }
}

widely! {
    /// The energy of a term; adds its forces.
    fn stressed(term: &Term, law: &Law, moved: &Nodal, forces: &mut Nodal) -> f64 {
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
