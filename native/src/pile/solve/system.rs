//! How all contacts give way to forces at each other, by all bodies that they share.
//!
//! Unknowns are the pushes of all contacts, then two forces aside of each that rubs; one without
//! friction has no more.

use glam::{DMat3, DVec3};

use super::mirrored::add_mirrored;
use super::products::{Side, seen_by};
use super::straight::Straight;
use crate::algebra::room;
use crate::contact::mobility::Mobility;
use crate::pile::between::Three;
use crate::pile::contact::{Contact, MOST_SHARES};
use crate::pile::member::Member;

/// Displacements along the unknowns under forces along these: `at_rest + matrix force`. Keeps its memory.
#[derive(Debug, Clone, Default)]
pub(super) struct System {
    /// Row by row, m/N. A row of a force aside holds all columns, others those of pushes.
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
    moved: Vec<Three>,
    parts: Vec<Three>,
    straight: Straight,
}

impl System {
    /// Sets up that of the contacts that are `chosen`, and those of them that rub; the gaps and places
    /// of contacts are those under their forces now. `away` are the contacts' ways now: gap, and from
    /// where they stuck.
    pub(super) fn set_up(
        &mut self,
        contacts: &[Contact],
        chosen: &[usize],
        members: &[Member],
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
        let count = pushes + 2 * self.rubs.len();
        self.matrix
            .resize((count * count).max(self.matrix.len()), 0.0);
        for row in 0..count {
            let columns = if row < pushes { pushes } else { count };
            self.matrix[row * count..][..columns].fill(0.0);
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
        for (body, member) in members.iter().enumerate() {
            self.find_sides(contacts, chosen, body, member);
            if self.rubs.is_empty() {
                self.give_way_straight(member);
            } else {
                self.give_way(member);
            }
            self.add_rest(member);
        }
        add_mirrored(&mut self.matrix, 0..pushes, count);
        add_mirrored(&mut self.matrix, pushes..count, count);
    }

    /// Has each contact give way by a share more of how far it does along its push.
    pub(super) fn add_springs(&mut self, shares: &[f64]) {
        let count = self.at_rest.len();
        self.springs.clear();
        for (contact, share) in shares.iter().enumerate() {
            let own = &mut self.matrix[contact * count + contact];
            self.springs.push(share * *own);
            *own += share * *own;
        }
    }

    /// Takes all memory that it ever needs for so many contacts.
    pub(super) fn reserve(&mut self, contacts: usize) {
        let unknowns = 3 * contacts;
        self.matrix = room(unknowns * unknowns);
        self.at_rest.reserve(unknowns);
        self.directions.reserve(contacts);
        self.rubs.reserve(contacts);
        self.aside.reserve(contacts);
        self.springs.reserve(contacts);
        self.sides.reserve(contacts);
        self.shares.reserve(MOST_SHARES * contacts);
        self.moved.reserve(contacts);
        self.parts.reserve(contacts);
        self.straight.reserve(contacts, MOST_SHARES);
    }

    fn find_sides(&mut self, contacts: &[Contact], chosen: &[usize], body: usize, member: &Member) {
        self.sides.clear();
        self.shares.clear();
        let turn = DMat3::from_quat(member.placement.rotation.inverse());
        let centre = (member.mobility).map_or(DVec3::ZERO, |mobility| mobility.centre);
        for (contact, &number) in chosen.iter().enumerate() {
            let sign = contacts[number].sign_on(body);
            if sign == 0.0 {
                continue;
            }
            let (first, mut place, mut last) = (self.shares.len(), DVec3::ZERO, 0);
            for &(point, share) in contacts[number].shares_on(body) {
                place += member.slots()[member.slot(point)].arm * share;
                self.shares.push((member.slot(point), share));
                last = last.max(member.slot(point));
            }
            let ways = turn * self.directions[contact] * sign;
            let mut along = [0.0; 12];
            for axis in 0..3 {
                let parts = ways.row(axis).to_array();
                along[4 * axis..][..3].copy_from_slice(&parts);
            }
            self.sides.push(Side {
                contact,
                slots: first..self.shares.len(),
                ways,
                along,
                arm: place - centre,
                last,
            });
        }
        // What one moves is then asked of slots up to its own last: half of them, all in all.
        self.sides
            .sort_unstable_by_key(|side| (side.last, side.contact));
    }

    /// The unknowns of a side and their ways on the body.
    #[inline]
    fn unknowns(&self, side: &Side) -> ([(usize, DVec3); 3], usize) {
        let [out, x, y] = [side.ways.x_axis, side.ways.y_axis, side.ways.z_axis];
        match self.aside[side.contact] {
            Some(aside) => ([(side.contact, out), (aside, x), (aside + 1, y)], 3),
            None => ([(side.contact, out); 3], 1),
        }
    }

    /// Adds how a body's surface gives way, and how it moves as a whole.
    fn give_way(&mut self, member: &Member) {
        let between = member.between();
        let (mut moved, mut parts) = (
            std::mem::take(&mut self.moved),
            std::mem::take(&mut self.parts),
        );
        parts.resize(self.sides.len(), [0.0; 12]);
        for number in 0..self.sides.len() {
            let loaded = &self.sides[number];
            let (own, owns) = self.unknowns(loaded);
            let ways = own.map(|(_, way)| way / member.young_modulus);
            let shares = &self.shares[loaded.slots.clone()];
            between.move_by(shares, &ways[..owns], loaded.last + 1, &mut moved);
            let carried = (member.mobility).map_or([[0.0; 12]; 4], |mobility| {
                carried(&mobility, loaded.arm, &loaded.ways)
            });
            let seen = &self.sides[..=number];
            seen_by(seen, &self.shares, &moved, &carried, &mut parts);
            self.add(number, &parts[..=number]);
        }
        (self.moved, self.parts) = (moved, parts);
    }

    /// The same where none rubs.
    fn give_way_straight(&mut self, member: &Member) {
        let (sides, shares, count) = (&self.sides, &self.shares, self.at_rest.len());
        let (straight, matrix) = (&mut self.straight, &mut self.matrix);
        straight.give_way(member, sides, shares, |number, parts| {
            let row = &mut matrix[sides[number].contact * count..][..count];
            for (side, part) in sides.iter().zip(parts) {
                row[side.contact] += part;
            }
        });
    }

    /// Adds what a side does to those up to it, and by symmetry they to it.
    fn add(&mut self, number: usize, parts: &[Three]) {
        let count = self.at_rest.len();
        let loaded = self.sides[number].contact;
        let own = self.aside[loaded];
        let (before, itself) = parts.split_at(number);
        for (side, by) in self.sides.iter().zip(before) {
            let seen = side.contact;
            self.matrix[loaded.max(seen) * count + loaded.min(seen)] += by[0];
            if let Some(aside) = own {
                let rows = &mut self.matrix[aside * count..][..2 * count];
                rows[seen] += by[4];
                rows[count + seen] += by[8];
            }
            let Some(other) = self.aside[seen] else {
                continue;
            };
            let rows = &mut self.matrix[other * count..][..2 * count];
            rows[loaded] += by[1];
            rows[count + loaded] += by[2];
            let Some(aside) = own else { continue };
            let (row, column, [xy, yx]) = if aside > other {
                (aside, other, [by[6], by[9]])
            } else {
                (other, aside, [by[9], by[6]])
            };
            let rows = &mut self.matrix[row * count + column..][..count + 2];
            rows[0] += by[5];
            rows[1] += xy;
            rows[count] += yx;
            rows[count + 1] += by[10];
        }
        for by in itself {
            self.matrix[loaded * count + loaded] += by[0];
            if let Some(aside) = own {
                let rows = &mut self.matrix[aside * count..][..2 * count];
                rows[loaded] += by[4];
                rows[count + loaded] += by[8];
                rows[aside] += by[5];
                rows[count + aside] += by[9];
                rows[count + aside + 1] += by[10];
            }
        }
    }

    /// Adds where the contacts of a body are without forces.
    fn add_rest(&mut self, member: &Member) {
        let drift = (member.mobility).map_or(DVec3::ZERO, |mobility| mobility.drift);
        for side in &self.sides {
            let elastic: DVec3 = (self.shares[side.slots.clone()].iter())
                .map(|&(slot, share)| member.slots()[slot].moved * share)
                .sum();
            let (own, owns) = self.unknowns(side);
            for &(unknown, way) in &own[..owns] {
                self.at_rest[unknown] += way.dot(drift - elastic);
            }
        }
    }

    /// A row of the matrix: up to the column of the last push, or of the last force aside.
    #[inline]
    pub(super) fn row(&self, number: usize) -> &[f64] {
        let count = self.at_rest.len();
        &self.matrix[number * count..][..count]
    }
}

/// How far unit forces along three ways, which act on a body so far from its centre, move that, and a
/// place besides per metre along each axis that it is from it.
fn carried(mobility: &Mobility, arm: DVec3, ways: &DMat3) -> [Three; 4] {
    let (turns, mut carried) = (mobility.turns(arm), [[0.0; 12]; 4]);
    for (k, way) in [ways.x_axis, ways.y_axis, ways.z_axis]
        .into_iter()
        .enumerate()
    {
        let turn = turns * way;
        let far = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn.cross(axis));
        let moves = [way * mobility.shift, far[0], far[1], far[2]];
        for (carried, moves) in carried.iter_mut().zip(moves) {
            carried[4 * k..][..3].copy_from_slice(&moves.to_array());
        }
    }
    carried
}
