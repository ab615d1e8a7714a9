//! How contacts without friction give way to each other: along their pushes alone.
//!
//! A force and what it moves are then one number each, and a third of the work of three directions.

use std::ops::Range;

use glam::DVec3;

use super::products::Side;
use crate::algebra::wide::{plus_product, widely};
use crate::pile::between::Padded;
use crate::pile::member::Member;

/// Parts of a wrench: forces and torques.
const PARTS: usize = 6;

/// The memory for it.
#[derive(Debug, Clone, Default)]
pub(super) struct Straight {
    /// Of each slot of a side: its way by its share.
    weights: Vec<Padded>,
    /// A part after the other: ways of all sides, and how they turn the body about its centre.
    wrenches: Vec<f64>,
    slots: Vec<Range<usize>>,
    loads: Vec<Padded>,
    moved: Vec<Padded>,
    parts: Vec<f64>,
}

impl Straight {
    /// Takes all memory that it ever needs for so many contacts, each of so many slots at most.
    pub(super) fn reserve(&mut self, contacts: usize, slots: usize) {
        self.weights.reserve(slots * contacts);
        self.wrenches.reserve(PARTS * contacts);
        self.slots.reserve(contacts);
        self.loads.reserve(slots);
        self.moved.reserve(contacts);
        self.parts.reserve(contacts);
    }

    /// Finds how the sides of a body, which are carried by these slots, give way to a push of each other;
    /// of each what those up to it do goes `to` its number.
    pub(super) fn give_way(
        &mut self,
        member: &Member,
        sides: &[Side],
        shares: &[(usize, f64)],
        mut to: impl FnMut(usize, &[f64]),
    ) {
        self.begin(sides, shares);
        let per_pascal = 1.0 / member.young_modulus;
        for (number, loaded) in sides.iter().enumerate() {
            let way = loaded.ways.x_axis;
            let own = &self.weights[loaded.slots.clone()];
            self.loads.clear();
            (self.loads).extend(
                own.iter()
                    .map(|weight| weight.map(|part| part * per_pascal)),
            );
            let (slots, moved) = (&shares[loaded.slots.clone()], &mut self.moved);
            (member.between()).move_along(slots, &self.loads, loaded.last + 1, moved);
            let (wrenches, parts) = (&self.wrenches, &mut self.parts[..=number]);
            parts.fill(0.0);
            if let Some(mobility) = &member.mobility {
                let turn = mobility.turns(loaded.arm) * way;
                carry(
                    wrenches,
                    sides.len(),
                    [mobility.shifts() * way, turn],
                    parts,
                );
            }
            let slots = &self.slots[..=number];
            add_seen(slots, shares, &self.weights, moved, parts);
            to(number, parts);
        }
    }

    fn begin(&mut self, sides: &[Side], shares: &[(usize, f64)]) {
        let count = sides.len();
        self.weights.resize(shares.len(), [0.0; 4]);
        self.wrenches.resize(PARTS * count, 0.0);
        self.parts.resize(count, 0.0);
        self.slots.clear();
        self.slots
            .extend(sides.iter().map(|side| side.slots.clone()));
        for (number, side) in sides.iter().enumerate() {
            let (way, own) = (side.ways.x_axis, side.slots.clone());
            for (weight, (_, share)) in self.weights[own.clone()].iter_mut().zip(&shares[own]) {
                *weight = (way * *share).extend(0.0).to_array();
            }
            let turning = side.arm.cross(way);
            for axis in 0..3 {
                self.wrenches[axis * count + number] = way[axis];
                self.wrenches[(3 + axis) * count + number] = turning[axis];
            }
        }
    }
}

widely! {
    /// How far the first pushes see a body carried that is shifted and turned.
    fn carry(wrenches: &[f64], count: usize, carried: [DVec3; 2], parts: &mut [f64]) {
        for (number, shares) in wrenches.chunks_exact(count).enumerate() {
            let by = carried[number / 3][number % 3];
            for (part, share) in parts.iter_mut().zip(shares) {
                *part = plus_product::<FUSED>(*part, by, *share);
            }
        }
    }
}

widely! {
    /// Adds how far they see slots moved.
    fn add_seen(
        sides: &[Range<usize>],
        shares: &[(usize, f64)],
        weights: &[Padded],
        moved: &[Padded],
        parts: &mut [f64],
    ) {
        for (own, part) in sides.iter().zip(parts) {
            let mut sum = [0.0; 4];
            let (shares, weights) = (&shares[own.start..own.end], &weights[own.start..own.end]);
            for ((slot, _), weight) in shares.iter().zip(weights) {
                let moved = &moved[*slot];
                for k in 0..4 {
                    sum[k] = plus_product::<FUSED>(sum[k], moved[k], weight[k]);
                }
            }
            *part += (sum[0] + sum[2]) + (sum[1] + sum[3]);
        }
    }
}
