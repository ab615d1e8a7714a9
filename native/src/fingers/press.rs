//! How fingers press whose tips are points, how tools answer to that, and what becomes of it.

use glam::{DMat3, DVec3};

use crate::contact::cones::{Blocks, Cone, MAX_FINGERS, Vectors};
use crate::proxy::SurfacePoint;

/// A finger on the body, or near it where the others move the surface.
#[derive(Debug, Clone, Copy)]
pub struct Press {
    /// Number of the body in the list.
    pub body: u8,
    /// Where on its surface.
    pub hold: SurfacePoint,
    /// It touches; otherwise only what the others do there is asked for.
    pub touches: bool,
    /// How far it asks the contact point to move from rest, m.
    pub displacement: DVec3,
    /// The part of that which it adds to what the others do, m.
    pub push: DVec3,
    /// What its force stays in; by default a cone about its push, as wide as that needs.
    pub cone: Option<Cone>,
    /// Of all that its device may see, over Young's modulus; infinite for no such limit.
    pub most_stiffness: f64,
    /// From 0 to 1 after it was lifted by a fault: how much it acts on the others.
    pub presence: f64,
    /// How far what the body remembers of past forces moves the place, m.
    pub remembered: DVec3,
    /// The part of that which is new in this tick, m.
    pub carried: DVec3,
}

/// Those that are there, by number.
pub type Presses = [Option<Press>; MAX_FINGERS];

/// How tools answer to the points' forces: they move each by some way and, per force on each, by more.
#[derive(Debug, Clone, Copy)]
pub struct Reaction {
    /// Without the points' forces, m.
    pub moved: Vectors,
    /// m/N at unit modulus; symmetric, never positive: tools that hold the body make it firmer.
    pub by: Blocks,
}

impl Default for Reaction {
    fn default() -> Self {
        Self {
            moved: [DVec3::ZERO; MAX_FINGERS],
            by: [[DMat3::ZERO; MAX_FINGERS]; MAX_FINGERS],
        }
    }
}

impl Reaction {
    /// Where what a point and the tools do to each other is reduced to such shares.
    pub fn reduce(&mut self, shares: &[f64; MAX_FINGERS]) {
        for (p, &share) in shares.iter().enumerate() {
            self.moved[p] *= share;
            for (q, &other) in shares.iter().enumerate() {
                self.by[p][q] *= share * other;
            }
        }
    }

    /// The compliance of points between tools that answer so.
    pub(super) fn on(&self, alone: &Blocks) -> Blocks {
        let mut blocks = *alone;
        for (row, by) in blocks.iter_mut().zip(&self.by) {
            for (block, by) in row.iter_mut().zip(by) {
                *block += *by;
            }
        }
        blocks
    }
}

/// What becomes of all presses.
pub type Answers = [Answer; MAX_FINGERS];

/// What becomes of a press; times Young's modulus for N and N/m.
#[derive(Debug, Clone, Copy, Default)]
pub struct Answer {
    /// On the body, as the device and the other fingers feel it.
    pub force: DVec3,
    /// On the body, were there nothing but the body between it and this finger.
    pub contact_force: DVec3,
    /// Its share of the energy of all, J at unit modulus.
    pub energy: f64,
    /// What its force does on the displacements that the body remembers, J at unit modulus.
    pub remembered: f64,
    /// What its own force alone puts into the body, J at unit modulus.
    pub own_energy: f64,
    /// How far the others move the contact point, and past forces, m.
    pub by_others: DVec3,
    /// How far its own force takes a body that nobody holds along, m.
    pub along: DVec3,
    /// How far the body itself has moved the contact point in this tick, m.
    pub carried: DVec3,
    /// How far the surface goes beyond what the finger asks, m: zero unless its force is on its cone.
    pub slip: DVec3,
    /// Of the contact point while the others hold theirs, in series with what keeps the device from
    /// seeing it whole: the most that any device sees.
    pub seen_stiffness: DMat3,
    /// Compliance of that which keeps the device from seeing it whole.
    pub spring: f64,
}

/// Those that are there, by number.
pub(crate) fn numbered<T: Copy>(
    some: &[Option<T>; MAX_FINGERS],
) -> impl Iterator<Item = (usize, T)> + '_ {
    some.iter()
        .enumerate()
        .filter_map(|(number, one)| one.map(|one| (number, one)))
}
