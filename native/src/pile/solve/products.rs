//! Products of which the matrix of a system is made.

use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::algebra::wide::{plus_product, widely};
use crate::pile::between::Three;

/// A contact as one body has it.
#[derive(Debug, Clone)]
pub(super) struct Side {
    pub contact: usize,
    /// Which of the slots of the body that carry forces carry its own.
    pub slots: Range<usize>,
    /// Takes the contact's directions, out and two across, to those of the body, as its force acts there.
    pub ways: DMat3,
    /// The same turned over, a part of each direction after the other.
    pub along: Three,
    /// Where the force acts on the body as a whole, from its centre, m.
    pub arm: DVec3,
    /// The last of the slots.
    pub last: usize,
}

/// Three forces on a body as a whole, as its places see it move: an axis after the other, by each force.
#[derive(Debug, Clone, Default)]
pub(super) struct Carried {
    /// How far its centre goes, and how far it is turned about that.
    pub shift: Three,
    pub turn: Three,
}

widely! {
    /// How far contacts are moved by three forces: some slots, which carry them by their shares, and the body
    /// as a whole. Of each contact an axis after the other, by each of the forces.
    fn move_sides(
        sides: &[Side],
        shares: &[(usize, f64)],
        slots: &[Three],
        carried: &Carried,
        moved: &mut [Three],
    ) {
        let Carried { shift, turn } = carried;
        for (side, moved) in sides.iter().zip(moved) {
            let mut sum = *shift;
            for (r, by, with) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                let (along, back) = (side.arm[with], -side.arm[by]);
                for k in 0..4 {
                    let one = plus_product::<FUSED>(sum[4 * r + k], along, turn[4 * by + k]);
                    sum[4 * r + k] = plus_product::<FUSED>(one, back, turn[4 * with + k]);
                }
            }
            for &(slot, share) in &shares[side.slots.start..side.slots.end] {
                let slot = &slots[slot];
                for k in 0..12 {
                    sum[k] = plus_product::<FUSED>(sum[k], share, slot[k]);
                }
            }
            *moved = sum;
        }
    }
}

widely! {
    /// What contacts see of how far they are moved: of each of the forces the parts along their three
    /// directions.
    fn look_along(sides: &[Side], moved: &[Three], parts: &mut [Three]) {
        for ((side, moved), parts) in sides.iter().zip(moved).zip(parts) {
            let along = &side.along;
            for way in 0..3 {
                let [x, y, z] = [moved[way], moved[4 + way], moved[8 + way]];
                for l in 0..4 {
                    let by_two = plus_product::<FUSED>(x * along[l], y, along[4 + l]);
                    parts[4 * way + l] = plus_product::<FUSED>(by_two, z, along[8 + l]);
                }
            }
        }
    }
}

/// Both one after the other: in one loop the compiler takes numbers apart that lie beside each other.
pub(super) fn seen_by(
    sides: &[Side],
    shares: &[(usize, f64)],
    slots: &[Three],
    carried: &Carried,
    [moved, parts]: [&mut Vec<Three>; 2],
) {
    for memory in [&mut *moved, &mut *parts] {
        memory.resize(sides.len(), [0.0; 12]);
    }
    move_sides(sides, shares, slots, carried, moved);
    look_along(sides, moved, parts);
}
