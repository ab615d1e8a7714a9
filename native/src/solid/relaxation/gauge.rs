//! The rigid motion that pins would hold, of a body without any.
//!
//! With M the masses of the nodes and R^ six rigid motions, orthonormal in M, P = 1 - R^ R^^T M takes rigid
//! motion out of displacements, by mass, and P^T = 1 - M R^ R^^T adds to forces what makes them balance, as
//! the body's compliance does (`core/compliance/free_body/`). Some of the motions may be loose: what
//! presses the body tells how it goes along these.

use crate::solid::domains::Nodal;
use crate::solid::history::{Field, add, dot};

/// A rigid motion of a body.
#[derive(Debug, Clone)]
struct Motion {
    /// R^ and M R^, the loads of inertia against it.
    of_nodes: Field,
    loads: Field,
    /// How readily it is followed where steps are chosen, m/N at 1 Pa; none where it is not loose.
    gives: f64,
}

/// Rigid motions of a body.
#[derive(Debug, Clone)]
pub struct Gauge {
    motions: Vec<Motion>,
}

impl Gauge {
    /// Of these motions with their loads, and how loose each is; None where they are not of one body of so
    /// many nodes.
    pub fn new(
        motions: Vec<Field>,
        loads: Vec<Field>,
        gives: &[f64],
        nodes: usize,
    ) -> Option<Self> {
        let fits = motions.len() == loads.len()
            && motions.len() == gives.len()
            && (motions.iter().chain(&loads)).all(|field| field.len() == nodes);
        let made = motions.into_iter().zip(loads).zip(gives);
        let made = made.map(|((of_nodes, loads), &gives)| Motion {
            of_nodes,
            loads,
            gives,
        });
        fits.then(|| Self {
            motions: made.collect(),
        })
    }

    /// P: takes rigid motion out of displacements.
    pub fn still(&self, moved: &mut Nodal) {
        for motion in &self.motions {
            let share = dot(&motion.loads, moved);
            add(moved, -share, &motion.of_nodes);
        }
    }

    /// P^T: adds to forces what makes them balance.
    pub fn balance(&self, forces: &mut Nodal) {
        self.balance_along(|_| true, forces);
    }

    /// The same along what is not loose.
    pub fn balance_held(&self, forces: &mut Nodal) {
        self.balance_along(|motion| motion.gives == 0.0, forces);
    }

    fn balance_along(&self, chosen: impl Fn(&Motion) -> bool, forces: &mut Nodal) {
        for motion in self.motions.iter().filter(|motion| chosen(motion)) {
            let share = dot(&motion.of_nodes, forces);
            add(forces, -share, &motion.loads);
        }
    }

    /// Adds the loose motion of some displacements to others.
    pub fn add_loose(&self, from: &Nodal, to: &mut Nodal) {
        for motion in self.loose() {
            let share = dot(&motion.loads, from);
            add(to, share, &motion.of_nodes);
        }
    }

    /// Adds what forces do along loose motions, as loads on these.
    pub fn add_loads(&self, forces: &Nodal, to: &mut Nodal) {
        for motion in self.loose() {
            let share = dot(&motion.of_nodes, forces);
            add(to, share, &motion.loads);
        }
    }

    /// Adds how far forces move the body along loose motions.
    pub fn give_way(&self, forces: &Nodal, to: &mut Nodal) {
        for motion in self.loose() {
            let share = motion.gives * dot(&motion.of_nodes, forces);
            add(to, share, &motion.of_nodes);
        }
    }

    fn loose(&self) -> impl Iterator<Item = &Motion> {
        self.motions.iter().filter(|motion| motion.gives > 0.0)
    }
}
