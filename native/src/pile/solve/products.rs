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

widely! {
    /// What moves some slots by three forces, and their body as a whole, as contacts see it: of each force
    /// the parts along their three directions. Slots carry a contact by their shares; of the body what is
    /// `carried` tells how far its centre goes, and any place besides, a metre from it along each axis.
    pub(super) fn seen_by(
        sides: &[Side],
        shares: &[(usize, f64)],
        moved: &[Three],
        carried: &[Three; 4],
        parts: &mut [Three],
    ) {
        for (side, parts) in sides.iter().zip(parts) {
            let mut sum = carried[0];
            for axis in 0..3 {
                let far = side.arm[axis];
                for k in 0..12 {
                    sum[k] = plus_product::<FUSED>(sum[k], far, carried[1 + axis][k]);
                }
            }
            for &(slot, share) in &shares[side.slots.start..side.slots.end] {
                let moved = &moved[slot];
                for k in 0..12 {
                    sum[k] = plus_product::<FUSED>(sum[k], share, moved[k]);
                }
            }
            let along = &side.along;
            for way in 0..3 {
                let [x, y, z] = [sum[4 * way], sum[4 * way + 1], sum[4 * way + 2]];
                for l in 0..4 {
                    let by_two = plus_product::<FUSED>(x * along[l], y, along[4 + l]);
                    parts[4 * way + l] = plus_product::<FUSED>(by_two, z, along[8 + l]);
                }
            }
        }
    }
}
