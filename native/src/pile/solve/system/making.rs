//! How a system's matrix is made: what each body does to all contacts that it has.

use glam::{DMat3, DVec3};

use super::System;
use crate::pile::between::{Three, turned_over};
use crate::pile::contact::Contact;
use crate::pile::member::Member;
use crate::pile::solve::mirrored::{add_mirrored, add_turned};
use crate::pile::solve::products::{Carried, Side, seen_by};

impl System {
    /// Makes the matrix, and finds where contacts are at rest.
    pub(super) fn make(&mut self, (contacts, chosen): (&[Contact], &[usize]), members: &[Member]) {
        let (pushes, count) = (chosen.len(), self.at_rest.len());
        self.matrix
            .resize((count * count).max(self.matrix.len()), 0.0);
        self.matrix[..count * count].fill(0.0);
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
        add_turned(&mut self.matrix, pushes, count);
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
            let (first, mut last) = (self.shares.len(), 0);
            let shares = contacts[number].shares_on(body);
            for &(point, share) in shares {
                self.shares.push((member.slot(point), share));
                last = last.max(member.slot(point));
            }
            let ways = turn * self.directions[contact] * sign;
            self.sides.push(Side {
                contact,
                slots: first..self.shares.len(),
                ways,
                along: turned_over(&ways),
                arm: member.arm(shares) - centre,
                last,
            });
        }
        // What one moves is then asked of slots up to its own last: half of them, all in all.
        self.sides
            .sort_unstable_by_key(|side| (side.last, side.contact));
    }

    /// Adds how a body's surface gives way, and how it moves as a whole.
    fn give_way(&mut self, member: &Member) {
        let between = member.between();
        for number in 0..self.sides.len() {
            let (loaded, seen) = (&self.sides[number], &self.sides[..=number]);
            let (ways, shares) = (loaded.ways, &self.shares[loaded.slots.clone()]);
            let by = ways / member.young_modulus;
            between.move_by(shares, &by, loaded.last + 1, &mut self.slots);
            let carried = (member.mobility).map_or_else(Carried::default, |mobility| Carried {
                shift: turned_over(&(mobility.shifts() * ways)),
                turn: turned_over(&(mobility.turns(loaded.arm) * ways)),
            });
            let memory = [&mut self.moved, &mut self.parts];
            seen_by(seen, &self.shares, &self.slots.slots, &carried, memory);
            let count = self.at_rest.len();
            add_side(&mut self.matrix, count, (seen, &self.aside), &self.parts);
        }
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

    /// Adds where the contacts of a body are without forces.
    fn add_rest(&mut self, member: &Member) {
        let drift = (member.mobility).map_or(DVec3::ZERO, |mobility| mobility.drift);
        for number in 0..self.sides.len() {
            let side = &self.sides[number];
            let elastic: DVec3 = (self.shares[side.slots.clone()].iter())
                .map(|&(slot, share)| member.slots()[slot].moved * share)
                .sum();
            let away = side.ways.transpose() * (drift - elastic);
            self.add_away(side.contact, away);
        }
    }
}

/// Adds what the last of some sides does to them, in its own rows; what they do to it is the same, and of what
/// it does to itself half is told. `asides` are first unknowns aside by contact.
fn add_side(
    matrix: &mut [f64],
    count: usize,
    (sides, asides): (&[Side], &[Option<usize>]),
    parts: &[Three],
) {
    let Some((loaded, before)) = sides.split_last() else {
        return;
    };
    let aside = asides[loaded.contact];
    let own = [Some(loaded.contact), aside, aside.map(|first| first + 1)];
    for (way, unknown) in own.into_iter().flatten().enumerate() {
        let row = &mut matrix[unknown * count..][..count];
        for (side, by) in before.iter().zip(parts) {
            let by = &by[4 * way..][..3];
            row[side.contact] += by[0];
            if let Some(aside) = asides[side.contact] {
                row[aside] += by[1];
                row[aside + 1] += by[2];
            }
        }
        let itself = &parts[before.len()][4 * way..];
        for (seen, by) in own.into_iter().flatten().zip(itself).take(way + 1) {
            row[seen] += by;
        }
    }
}
