//! How all contacts give way to forces at each other, by all bodies that they share.
//!
//! Unknowns are the pushes of all contacts, then two forces aside of each that rubs; one without
//! friction has no more.

mod making;
mod staying;

use glam::{DMat3, DVec3};

use super::kept::Kept;
use super::products::Side;
use super::straight::Straight;
use crate::algebra::room;
use crate::contact::mobility::Motion;
use crate::pile::between::{Moved, Three};
use crate::pile::contact::{Contact, MOST_SHARES};
use crate::pile::member::Member;

/// Displacements along the unknowns under forces along these: `at_rest + matrix force`. Keeps its memory.
#[derive(Debug, Clone, Default)]
pub(super) struct System {
    /// Row by row, m/N. The columns of forces aside in rows of pushes hold what is not yet added to the others.
    matrix: Vec<f64>,
    /// Of no force at all, with what weight does in this tick, m.
    pub at_rest: Vec<f64>,
    /// Of each contact: out, and two directions across, in the world.
    pub directions: Vec<DMat3>,
    /// The contacts that rub, in the order of their unknowns.
    pub rubs: Vec<usize>,
    /// Of each contact its first unknown aside; none of one that does not rub.
    aside: Vec<Option<usize>>,
    /// By how much each contact gives way besides, m/N.
    pub springs: Vec<f64>,
    sides: Vec<Side>,
    /// Slots of a body that carry forces, and their shares.
    shares: Vec<(usize, f64)>,
    slots: Moved,
    moved: Vec<Three>,
    parts: Vec<Three>,
    straight: Straight,
    /// What the matrix was made of; whether it is that of the last tick.
    kept: Kept,
    pub is_kept: bool,
    /// How forces that stay would move bodies as a whole.
    driven: Vec<Motion>,
}

impl System {
    /// Begins with contacts that are `chosen`, and those of them that rub. `away` are the contacts' ways now: gap,
    /// and from where they stuck.
    pub(super) fn begin(
        &mut self,
        (contacts, chosen): (&[Contact], &[usize]),
        (away, rubs): (&[DVec3], impl Fn(usize) -> bool),
    ) {
        let pushes = chosen.len();
        self.rubs.clear();
        self.rubs.extend((0..pushes).filter(|&place| rubs(place)));
        self.aside.clear();
        self.aside.resize(pushes, None);
        for (k, &place) in self.rubs.iter().enumerate() {
            self.aside[place] = Some(pushes + 2 * k);
        }
        self.at_rest.clear();
        self.at_rest.extend(away.iter().map(|way| way.x));
        let across = self
            .rubs
            .iter()
            .flat_map(|&place| [away[place].y, away[place].z]);
        self.at_rest.extend(across);
        self.directions.clear();
        self.directions.extend(chosen.iter().map(|&number| {
            let normal = contacts[number].normal;
            let (first, second) = normal.any_orthonormal_pair();
            DMat3::from_cols(normal, first, second)
        }));
    }

    /// Sets it up; gaps and places of contacts are those under their forces now, which are told along the
    /// unknowns. Where it may keep what it has, it does while contacts lie nearly as they did.
    pub(super) fn set_up(
        &mut self,
        (contacts, chosen): (&[Contact], &[usize]),
        members: &[Member],
        (forces, may_keep): (&[f64], bool),
    ) {
        let told = (contacts, chosen);
        // What presses and is not chosen will not: what would be if all forces stayed is not known then.
        let pressing = contacts.iter().filter(|contact| contact.push > 0.0).count();
        let pushes = forces[..chosen.len()].iter();
        let is_whole = pressing == pushes.filter(|&&push| push > 0.0).count();
        let (directions, rubs) = (&self.directions, &self.rubs);
        self.is_kept = may_keep && is_whole && self.kept.is_near(told, members, (directions, rubs));
        if self.is_kept {
            return self.stay(told, members, forces);
        }
        self.make(told, members);
        if may_keep {
            (self.kept).take(told, members, (&self.directions, &self.rubs));
        }
    }

    /// Has each contact give way by a share more of how far it does along its push: beside the matrix.
    pub(super) fn find_springs(&mut self, shares: &[f64]) {
        let count = self.at_rest.len();
        let own = self.matrix.iter().step_by(count + 1);
        self.springs.clear();
        self.springs
            .extend(shares.iter().zip(own).map(|(share, own)| share * own));
    }

    /// Takes all memory that it ever needs for so many contacts of so many bodies.
    pub(super) fn reserve(&mut self, contacts: usize, bodies: usize) {
        let unknowns = 3 * contacts;
        self.matrix = room(unknowns * unknowns);
        self.at_rest.reserve(unknowns);
        self.directions.reserve(contacts);
        self.rubs.reserve(contacts);
        self.aside.reserve(contacts);
        self.springs.reserve(contacts);
        self.sides.reserve(contacts);
        self.shares.reserve(MOST_SHARES * contacts);
        self.slots.reserve(contacts);
        self.moved.reserve(contacts);
        self.parts.reserve(contacts);
        self.straight.reserve(contacts, MOST_SHARES);
        self.kept.reserve(contacts, bodies);
        self.driven.reserve(bodies);
    }

    /// Adds how far away a contact is besides, along its directions.
    fn add_away(&mut self, contact: usize, away: DVec3) {
        self.at_rest[contact] += away.x;
        if let Some(aside) = self.aside[contact] {
            self.at_rest[aside] += away.y;
            self.at_rest[aside + 1] += away.z;
        }
    }

    /// A row of the matrix: up to the column of the last push, or of the last force aside.
    #[inline]
    pub(super) fn row(&self, number: usize) -> &[f64] {
        let count = self.at_rest.len();
        &self.matrix[number * count..][..count]
    }
}
