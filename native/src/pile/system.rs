//! How all contacts give way to forces at each other, by all bodies that they share.
//!
//! Unknowns are the pushes of all contacts, then two forces aside of each that rubs; one without
//! friction has no more. What moves a body as a whole is of rank six: it is added as six products.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::between::Three;
use super::contact::Contact;
use super::member::Member;
use crate::algebra::wide::{plus_product, widely};
use crate::contact::mobility::Mobility;

/// A contact as one body has it.
#[derive(Debug, Clone)]
struct Side {
    contact: usize,
    /// Which of the slots of the body that carry forces carry its own.
    slots: Range<usize>,
    /// Takes the contact's directions, out and two across, to those of the body, as its force acts there.
    ways: DMat3,
    /// The same turned over, a part of each direction after the other.
    along: Three,
    /// Where the force acts on the body as a whole, m.
    place: DVec3,
}

/// Displacements along the unknowns under forces along these: `at_rest + matrix force`. Keeps its memory.
#[derive(Debug, Clone, Default)]
pub(super) struct System {
    /// Row by row, m/N. A row holds the columns up to its own, and one of a force aside all of these.
    matrix: Vec<f64>,
    /// Of no force at all, with what weight does in this tick, m.
    pub at_rest: Vec<f64>,
    /// Of each contact: out, and two directions across, in the world.
    pub directions: Vec<DMat3>,
    /// The contacts that rub, in the order of their unknowns.
    pub rubs: Vec<usize>,
    /// Of each contact its first unknown aside; none of one that does not rub.
    aside: Vec<Option<usize>>,
    sides: Vec<Side>,
    /// Slots of a body that carry forces, and their shares.
    shares: Vec<(usize, f64)>,
    sum: Vec<Three>,
    moved: Vec<Three>,
    /// Unit forces along all unknowns as wrenches on a body, an entry of these after the other.
    wrenches: Vec<f64>,
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
        mobilities: &[Option<Mobility>],
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
            self.matrix[row * count..][..=row].fill(0.0);
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
            self.give_way(member);
            self.add_motion(mobilities[body].as_ref());
            self.add_rest(member, mobilities[body].as_ref());
        }
        mirror(&mut self.matrix, pushes, count);
    }

    fn find_sides(&mut self, contacts: &[Contact], chosen: &[usize], body: usize, member: &Member) {
        self.sides.clear();
        self.shares.clear();
        let points = member.surface.points();
        let turn = DMat3::from_quat(member.placement.rotation.inverse());
        for (contact, &number) in chosen.iter().enumerate() {
            let sign = contacts[number].sign_on(body);
            if sign == 0.0 {
                continue;
            }
            let (first, mut place) = (self.shares.len(), DVec3::ZERO);
            for &(point, share) in contacts[number].shares_on(body) {
                place += points[point as usize].position * share;
                self.shares.push((member.slot(point), share));
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
                place,
            });
        }
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

    /// Adds how a body's surface gives way.
    fn give_way(&mut self, member: &Member) {
        let (between, slots) = (member.between(), member.slots().len());
        let (mut sum, mut moved) = (
            std::mem::take(&mut self.sum),
            std::mem::take(&mut self.moved),
        );
        for number in 0..self.sides.len() {
            let loaded = &self.sides[number];
            let (own, owns) = self.unknowns(loaded);
            let ways = own.map(|(_, way)| way);
            let shares = &self.shares[loaded.slots.clone()];
            between.move_by(shares, &ways[..owns], slots, &mut sum, &mut moved);
            let (contact, aside) = (loaded.contact, self.aside[loaded.contact]);
            for (other, seen) in self.sides[..=number].iter().enumerate() {
                let by = seen_by(&self.shares[seen.slots.clone()], &moved, &seen.along);
                // Rows of the later unknown of each pair; pairs of a contact with itself once.
                let (first, count) = (seen.contact, self.at_rest.len());
                self.matrix[contact * count + first] += by[0];
                if let Some(aside) = aside {
                    self.matrix[aside * count + first] += by[4];
                    self.matrix[(aside + 1) * count + first] += by[8];
                }
                let Some(column) = self.aside[first] else {
                    continue;
                };
                if other < number {
                    self.matrix[column * count + contact] += by[1];
                    self.matrix[(column + 1) * count + contact] += by[2];
                }
                if let Some(aside) = aside {
                    self.matrix[aside * count + column] += by[5];
                    if other < number {
                        self.matrix[aside * count + column + 1] += by[6];
                    }
                    let row = &mut self.matrix[(aside + 1) * count + column..][..2];
                    (row[0], row[1]) = (row[0] + by[9], row[1] + by[10]);
                }
            }
        }
        (self.sum, self.moved) = (sum, moved);
    }

    /// Adds how a body moves as a whole.
    fn add_motion(&mut self, mobility: Option<&Mobility>) {
        let Some(mobility) = mobility else { return };
        let count = self.at_rest.len();
        self.wrenches.clear();
        self.wrenches.resize(6 * count, 0.0);
        for number in 0..self.sides.len() {
            let side = &self.sides[number];
            let (own, owns) = self.unknowns(side);
            let arm = side.place - mobility.centre;
            for &(unknown, way) in &own[..owns] {
                let torque = arm.cross(way);
                for axis in 0..3 {
                    self.wrenches[axis * count + unknown] = way[axis];
                    self.wrenches[(3 + axis) * count + unknown] = torque[axis];
                }
            }
        }
        for side in &self.sides {
            let (own, owns) = self.unknowns(side);
            let arm = side.place - mobility.centre;
            for &(unknown, way) in &own[..owns] {
                let (shift, turn) = (way * mobility.shift, mobility.turn * arm.cross(way));
                let moves = [shift.x, shift.y, shift.z, turn.x, turn.y, turn.z];
                let row = &mut self.matrix[unknown * count..][..=unknown];
                add_six(&self.wrenches, count, &moves, row);
            }
        }
    }

    /// Adds where the contacts of a body are without forces.
    fn add_rest(&mut self, member: &Member, mobility: Option<&Mobility>) {
        let drift = mobility.map_or(DVec3::ZERO, |mobility| mobility.drift);
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

    /// A row of the matrix: up to its own column, or that of the last force aside.
    #[inline]
    pub(super) fn row(&self, number: usize) -> &[f64] {
        let count = self.at_rest.len();
        &self.matrix[number * count..][..count]
    }
}

widely! {
    /// What moves some slots by three forces, as a contact that they carry by their shares sees it: of
    /// each force the parts along its three directions.
    fn seen_by(shares: &[(usize, f64)], moved: &[Three], along: &Three) -> Three {
        let (mut sum, mut parts) = ([0.0; 12], [0.0; 12]);
        for &(slot, share) in shares {
            let moved = &moved[slot];
            for k in 0..12 {
                sum[k] = plus_product::<FUSED>(sum[k], share, moved[k]);
            }
        }
        for way in 0..3 {
            for l in 0..4 {
                let of = |axis: usize| (sum[4 * way + axis], along[4 * axis + l]);
                let [(x, by_x), (y, by_y), (z, by_z)] = [of(0), of(1), of(2)];
                let by_two = plus_product::<FUSED>(x * by_x, y, by_y);
                parts[4 * way + l] = plus_product::<FUSED>(by_two, z, by_z);
            }
        }
        parts
    }
}

widely! {
    /// Adds six rows, each so many times, to one as far as it reaches.
    fn add_six(rows: &[f64], count: usize, times: &[f64; 6], to: &mut [f64]) {
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|k: usize| &rows[k * count..][..to.len()]);
        for i in 0..to.len() {
            let by_shift = plus_product::<FUSED>(times[0] * a[i], times[1], b[i]);
            let by_shift = plus_product::<FUSED>(by_shift, times[2], c[i]);
            let by_turn = plus_product::<FUSED>(times[3] * d[i], times[4], e[i]);
            let by_turn = plus_product::<FUSED>(by_turn, times[5], f[i]);
            to[i] += by_shift + by_turn;
        }
    }
}

/// Copies what is below the diagonal of the rows and columns from `first` on to above it.
fn mirror(matrix: &mut [f64], first: usize, count: usize) {
    for row in first..count {
        for column in first..row {
            matrix[column * count + row] = matrix[row * count + column];
        }
    }
}
