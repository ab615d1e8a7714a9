//! Products of what is kept of one slot of a patch with vectors of all slots before it.

use glam::DVec3;

use crate::algebra::MOST_POINTS;
use crate::algebra::cholesky::dot_three;
use crate::algebra::wide::{LANES, plus_product, widely};

/// A vector for each slot, an axis after the other.
pub(in crate::tool) type Vectors = [[f64; MOST_POINTS]; 3];

#[inline]
pub(super) fn at(vectors: &Vectors, i: usize) -> DVec3 {
    DVec3::new(vectors[0][i], vectors[1][i], vectors[2][i])
}

#[inline]
pub(super) fn set(vectors: &mut Vectors, i: usize, vector: DVec3) {
    for (axis, number) in vectors.iter_mut().zip(vector.to_array()) {
        axis[i] = number;
    }
}

/// An entry of the blocks, row by row, of the first slots.
#[inline(always)]
fn entry(blocks: &[f64], number: usize, count: usize) -> &[f64] {
    &blocks[blocks.len() / 9 * number..][..count]
}

/// A number with the product of a row of a block and a force.
#[inline(always)]
fn plus_three<const FUSED: bool>(to: f64, [x, y, z]: [f64; 3], force: DVec3) -> f64 {
    let one = plus_product::<FUSED>(to, x, force.x);
    let two = plus_product::<FUSED>(one, y, force.y);
    plus_product::<FUSED>(two, z, force.z)
}

widely! {
    /// Adds how far the first slots move under a force on the one whose blocks these are.
    pub(super) fn add_moved(blocks: &[f64], force: DVec3, moved: &mut Vectors, count: usize) {
        for (r, axis) in moved.iter_mut().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|c| entry(blocks, 3 * r + c, count));
            let sums = &mut axis[..count];
            for i in 0..sums.len() {
                sums[i] = plus_three::<FUSED>(sums[i], [x[i], y[i], z[i]], force);
            }
        }
    }
}

widely! {
    /// How far the one whose blocks these are moves under forces on the first slots.
    pub(super) fn gather(blocks: &[f64], forces: &Vectors, count: usize) -> [f64; 3] {
        let mut moved = [0.0; 3];
        for (c, sum) in moved.iter_mut().enumerate() {
            let part = |r: usize| entry(blocks, 3 * r + c, count);
            let [x, y, z] = forces;
            let forces = [&x[..count], &y[..count], &z[..count]];
            *sum = dot_three::<FUSED>([part(0), part(1), part(2)], forces);
        }
        moved
    }
}

widely! {
    /// How far the first slots move, each along its own way, under a force on the one whose blocks
    /// these are.
    pub(super) fn add_along(blocks: &[f64], force: DVec3, ways: &Vectors, along: &mut [f64]) {
        let count = along.len();
        along.fill(0.0);
        for (r, way) in ways.iter().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|c| entry(blocks, 3 * r + c, count));
            let way = &way[..count];
            for i in 0..count {
                let ahead = plus_three::<FUSED>(0.0, [x[i], y[i], z[i]], force);
                along[i] = plus_product::<FUSED>(along[i], way[i], ahead);
            }
        }
    }
}

widely! {
    /// How far the first slots move, each along its own way, under the first force on the one whose
    /// blocks these are, and, added up, under the second; the work of the first force on what forces on
    /// the first slots move that one. Entries that are there to fill up are zero.
    pub(super) fn add_both(
        blocks: &[f64],
        forces: [DVec3; 2],
        vectors: [&Vectors; 2],
        moved: [&mut [f64; MOST_POINTS]; 2],
    ) -> f64 {
        let ([first, second], [ways, others], [along, by]) = (forces, vectors, moved);
        let count = blocks.len() / 9;
        let mut lanes = [0.0; LANES];
        for k in (0..count).step_by(LANES) {
            let (mut by_first, mut by_second) = ([0.0; LANES], [0.0; LANES]);
            for r in 0..3 {
                let row = &blocks[3 * r * count..][..3 * count];
                let (x, y) = (&row[k..][..LANES], &row[count + k..][..LANES]);
                let z = &row[2 * count + k..][..LANES];
                let (way, other) = (&ways[r][k..][..LANES], &others[r][k..][..LANES]);
                for l in 0..LANES {
                    let row = [x[l], y[l], z[l]];
                    let ahead = plus_three::<FUSED>(0.0, row, first);
                    let aside = plus_three::<FUSED>(0.0, row, second);
                    by_first[l] = plus_product::<FUSED>(by_first[l], way[l], ahead);
                    lanes[l] = plus_product::<FUSED>(lanes[l], other[l], ahead);
                    by_second[l] = plus_product::<FUSED>(by_second[l], way[l], aside);
                }
            }
            let (along, by) = (&mut along[k..][..LANES], &mut by[k..][..LANES]);
            along.copy_from_slice(&by_first);
            for l in 0..LANES {
                by[l] += by_second[l];
            }
        }
        let mut sum = 0.0;
        for lane in lanes {
            sum += lane;
        }
        sum
    }
}
