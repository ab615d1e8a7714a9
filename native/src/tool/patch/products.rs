//! Products of what is kept of one slot of a patch with vectors of all slots before it.

use glam::DVec3;

use crate::algebra::MOST_POINTS;
use crate::algebra::cholesky::total;
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

/// Makes vectors behind the last slot zero as far as a register reaches: no number, which may be left
/// there, times what fills blocks up would be none.
#[inline]
pub(super) fn fill_up(vectors: &mut Vectors, slots: usize) {
    for axis in vectors {
        axis[slots..slots.next_multiple_of(LANES)].fill(0.0);
    }
}

/// How far a slot, whose blocks these are, moves under the forces on those before it.
#[inline]
pub(super) fn gather(blocks: &[f64], forces: &mut Vectors, slot: usize) -> [f64; 3] {
    without_own(forces, slot, |forces| gather_all(blocks, forces))
}

/// The same, and adds how far it and those before it move under the force on it.
#[inline]
pub(super) fn gather_and_add(
    blocks: &[f64],
    forces: &mut Vectors,
    slot: usize,
    moved: &mut Vectors,
) -> [f64; 3] {
    let own = at(forces, slot);
    without_own(forces, slot, |forces| {
        gather_and_add_all(blocks, forces, own, moved)
    })
}

/// What is found while there is no force on a slot.
#[inline]
fn without_own(
    forces: &mut Vectors,
    slot: usize,
    find: impl FnOnce(&Vectors) -> [f64; 3],
) -> [f64; 3] {
    let own = at(forces, slot);
    set(forces, slot, DVec3::ZERO);
    let moved = find(forces);
    set(forces, slot, own);
    moved
}

widely! {
    /// The same of forces on slots up to it. Entries that are there to fill up are zero.
    fn gather_all(blocks: &[f64], forces: &Vectors) -> [f64; 3] {
        let count = blocks.len() / 9;
        let mut moved = [0.0; 3];
        for (c, sum) in moved.iter_mut().enumerate() {
            let part = |r: usize| entry(blocks, 3 * r + c, count);
            let rows = [part(0), part(1), part(2)];
            let forces = [&forces[0][..count], &forces[1][..count], &forces[2][..count]];
            let mut lanes = [0.0; LANES];
            for k in (0..count).step_by(LANES) {
                for r in 0..3 {
                    let (row, force) = (&rows[r][k..k + LANES], &forces[r][k..k + LANES]);
                    for l in 0..LANES {
                        lanes[l] = plus_product::<FUSED>(lanes[l], row[l], force[l]);
                    }
                }
            }
            *sum = total::<FUSED>(&lanes, &[], &[]);
        }
        moved
    }
}

widely! {
    /// The same, and adds how far these slots move under a force on the one whose blocks these are: what is
    /// loaded of the blocks serves both.
    fn gather_and_add_all(
        blocks: &[f64],
        forces: &Vectors,
        own: DVec3,
        moved: &mut Vectors,
    ) -> [f64; 3] {
        let count = blocks.len() / 9;
        let mut lanes = [[0.0; LANES]; 3];
        for (r, rows) in blocks.chunks_exact(3 * count).enumerate() {
            let (x, rest) = rows.split_at(count);
            let (y, z) = rest.split_at(count);
            let rows = (x.chunks_exact(LANES).zip(y.chunks_exact(LANES))).zip(z.chunks_exact(LANES));
            let forces = forces[r][..count].chunks_exact(LANES);
            let moved = moved[r][..count].chunks_exact_mut(LANES);
            for ((((x, y), z), force), moved) in rows.zip(forces).zip(moved) {
                for l in 0..LANES {
                    moved[l] = plus_three::<FUSED>(moved[l], [x[l], y[l], z[l]], own);
                    lanes[0][l] = plus_product::<FUSED>(lanes[0][l], x[l], force[l]);
                    lanes[1][l] = plus_product::<FUSED>(lanes[1][l], y[l], force[l]);
                    lanes[2][l] = plus_product::<FUSED>(lanes[2][l], z[l], force[l]);
                }
            }
        }
        lanes.map(|lanes| total::<FUSED>(&lanes, &[], &[]))
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

widely! {
    /// Has the first slots be shifted by that much more along these ways under forces on the one whose
    /// blocks these are, and turned as these turn their body now, no more as they did; by where slots
    /// were and are from its centre.
    pub(super) fn carry_otherwise(
        blocks: &mut [f64],
        shifts: &[f64],
        ways: [[f64; 3]; 3],
        arms: [&Vectors; 2],
        turns: [[[f64; 3]; 3]; 2],
    ) {
        let (count, room) = (shifts.len(), blocks.len() / 9);
        for c in 0..3 {
            let [gone, comes] = [turns[0][c], turns[1][c]];
            for r in 0..3 {
                // Of the vector product of turn and arm.
                let (a, b) = ((r + 1) % 3, (r + 2) % 3);
                let [from_a, from_b] = [a, b].map(|axis: usize| &arms[0][axis][..count]);
                let [to_a, to_b] = [a, b].map(|axis: usize| &arms[1][axis][..count]);
                let entry = &mut blocks[(3 * r + c) * room..][..count];
                for i in 0..count {
                    let now = plus_product::<FUSED>(comes[a] * to_b[i], -comes[b], to_a[i]);
                    let before = plus_product::<FUSED>(gone[a] * from_b[i], -gone[b], from_a[i]);
                    entry[i] += now - before;
                }
                let way = ways[c][r];
                if way != 0.0 {
                    for i in 0..count {
                        entry[i] += way * shifts[i];
                    }
                }
            }
        }
    }
}
