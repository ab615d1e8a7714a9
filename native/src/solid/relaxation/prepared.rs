//! What is prepared of a body once, to relax it.

use super::gauge::Gauge;
use crate::solid::domains::{Domains, Nodal};
use crate::solid::factor;
use crate::solid::factor::Factor;
use crate::solid::history::add;
use crate::solid::strained::{Springs, Strained};
use crate::solid::warp::Warp;

/// A body on its free nodes, ready to be relaxed.
#[derive(Debug)]
pub struct Solid {
    /// Its energy; of the first term's domains the warp is.
    pub strained: Strained,
    /// From linear displacements to others.
    pub warp: Warp,
    /// Of the stiffness at rest; of a body that nothing holds with springs that its balanced forces do not feel.
    pub stiffness: Factor<f32>,
    /// Of a body that nothing holds, none of it loose.
    pub gauge: Option<Gauge>,
}

impl Solid {
    /// How many nodes are free.
    pub fn nodes(&self) -> usize {
        self.stiffness.len() / 3
    }

    /// What it is warped by.
    pub(super) fn warped_by(&self) -> (&Domains, Option<&Springs>) {
        (
            &self.strained.terms[0].domains,
            self.strained.springs.as_ref(),
        )
    }

    /// The displacement that the stiffness at rest gives for forces, which balance then where nothing holds
    /// the body.
    pub(super) fn solve(
        &self,
        gauge: Option<&Gauge>,
        forces: &mut Nodal,
        room: &mut factor::Room<f32>,
        moved: &mut Nodal,
    ) {
        let Some(gauge) = gauge else {
            return self.stiffness.solve_freedoms(forces, room, moved);
        };
        let mut loose = vec![[0.0; 3]; forces.len()];
        gauge.give_way(forces, &mut loose);
        gauge.balance(forces);
        self.stiffness.solve_freedoms(forces, room, moved);
        gauge.still(moved);
        add(moved, 1.0, &loose);
    }
}
