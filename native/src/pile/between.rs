//! How the contact points of a body that are looked at give way to forces on each other.

use glam::DMat3;

use super::contact::MOST_SHARES;
use crate::algebra::wide::{add, plus_product, widely};

/// Places at first.
const ROOM: usize = 128;

/// Three by three numbers, each three with a place for a register's fourth.
pub(super) type Three = [f64; 12];

/// A vector with a place for a register's fourth number.
pub(super) type Padded = [f64; 4];

/// Numbers of a block.
const NINE: usize = 9;

/// Numbers from one row of blocks to the next: behind the last block a register reaches farther.
#[inline]
fn row(room: usize) -> usize {
    NINE * room + 1
}

/// Compliance between all slots, kept while they come and go: of each that is loaded a block for all
/// that are moved, column after column. A column is read with one number too much, of which nothing is made.
#[derive(Debug, Clone, Default)]
pub(super) struct Between {
    room: usize,
    blocks: Vec<f64>,
}

/// How slots move by three forces.
#[derive(Debug, Clone, Default)]
pub(super) struct Moved {
    /// Of each slot an axis after the other, by each of the forces.
    pub slots: Vec<Three>,
    /// Memory for blocks that are added up.
    sums: Vec<f64>,
}

impl Moved {
    /// Takes all memory that it ever needs for so many slots.
    pub(super) fn reserve(&mut self, slots: usize) {
        self.slots.reserve(slots);
        self.sums.reserve(NINE * slots);
    }
}

impl Between {
    /// Where a block is.
    #[inline]
    fn at(&self, moved: usize, loaded: usize) -> usize {
        loaded * row(self.room) + NINE * moved
    }

    /// How a slot moves by a force on another, m/N at unit modulus.
    fn block(&self, moved: usize, loaded: usize) -> DMat3 {
        DMat3::from_cols_slice(&self.blocks[self.at(moved, loaded)..][..NINE])
    }

    /// Takes down how a slot moves by a force on another, and the other way round.
    fn put(&mut self, moved: usize, loaded: usize, block: &DMat3) {
        let (there, back) = (self.at(moved, loaded), self.at(loaded, moved));
        self.blocks[there..][..NINE].copy_from_slice(&block.to_cols_array());
        self.blocks[back..][..NINE].copy_from_slice(&block.transpose().to_cols_array());
    }

    /// Takes in a slot behind the last: how each up to it moves by a force on it.
    pub(super) fn enter(&mut self, new: usize, moves: impl Fn(usize) -> DMat3) {
        if new >= self.room {
            self.grow((2 * self.room).max(ROOM), new);
        }
        for other in 0..=new {
            self.put(other, new, &moves(other));
        }
    }

    /// Lets one go; the last one takes its place.
    pub(super) fn leave(&mut self, slot: usize, last: usize) {
        if slot == last {
            return;
        }
        for other in (0..last).filter(|&other| other != slot) {
            let block = self.block(other, last);
            self.put(other, slot, &block);
        }
        let own = self.block(last, last);
        self.put(slot, slot, &own);
    }

    /// Has room for so many slots, of which there are none yet.
    pub(super) fn reserve(&mut self, room: usize) {
        if room > self.room {
            self.grow(room, self.room);
        }
    }

    fn grow(&mut self, room: usize, slots: usize) {
        let mut blocks = vec![0.0; row(room) * room];
        for slot in 0..slots {
            let from = &self.blocks[self.at(0, slot)..][..NINE * slots];
            blocks[slot * row(room)..][..NINE * slots].copy_from_slice(from);
        }
        (self.room, self.blocks) = (room, blocks);
    }

    /// How the first `count` slots move by forces on some.
    pub(super) fn move_along(
        &self,
        shares: &[(usize, f64)],
        forces: &[Padded],
        count: usize,
        moved: &mut Vec<Padded>,
    ) {
        moved.resize(count, [0.0; 4]);
        let mut blocks = [&self.blocks[..0]; MOST_SHARES];
        add_up(self.of(shares, count, &mut blocks), forces, moved);
    }

    /// The blocks of the first `count` slots for some that are loaded.
    #[inline]
    fn of<'a, 'b>(
        &'a self,
        loaded: &[(usize, f64)],
        count: usize,
        blocks: &'b mut [&'a [f64]; MOST_SHARES],
    ) -> &'b [&'a [f64]] {
        for (blocks, &(slot, _)) in blocks.iter_mut().zip(loaded) {
            *blocks = &self.blocks[self.at(0, slot)..][..row(count)];
        }
        &blocks[..loaded.len()]
    }

    /// How the first `count` slots move by a unit force along each of three ways, shared out among some.
    pub(super) fn move_by(
        &self,
        shares: &[(usize, f64)],
        ways: &DMat3,
        count: usize,
        moved: &mut Moved,
    ) {
        let Moved { slots, sums } = moved;
        slots.resize(count, [0.0; 12]);
        let column = |slot: usize| &self.blocks[self.at(0, slot)..][..NINE * count];
        if let [(slot, share)] = *shares {
            return turn(column(slot), &turned_over(&(*ways * share)), slots);
        }
        sums.clear();
        sums.resize(NINE * count, 0.0);
        for &(slot, share) in shares {
            add(share, column(slot), sums);
        }
        turn(sums, &turned_over(ways), slots);
    }
}

/// Of three vectors, which are columns, an axis after the other.
pub(super) fn turned_over(columns: &DMat3) -> Three {
    let mut axes = [0.0; 12];
    for axis in 0..3 {
        axes[4 * axis..][..3].copy_from_slice(&columns.row(axis).to_array());
    }
    axes
}

widely! {
    /// What the blocks of each slot make of a force each, added up.
    fn add_up(blocks: &[&[f64]], forces: &[Padded], moved: &mut [Padded]) {
        for (slot, moved) in moved.iter_mut().enumerate() {
            let mut sum = [0.0; 4];
            for (blocks, force) in blocks.iter().zip(forces) {
                let block = &blocks[NINE * slot..][..=NINE];
                for c in 0..3 {
                    for r in 0..4 {
                        sum[r] = plus_product::<FUSED>(sum[r], force[c], block[3 * c + r]);
                    }
                }
            }
            *moved = sum;
        }
    }
}

widely! {
    /// What the block of each slot makes of three ways, of which all are told axis by axis.
    fn turn(blocks: &[f64], ways: &Three, moved: &mut [Three]) {
        for (block, moved) in blocks.chunks_exact(NINE).zip(moved) {
            for r in 0..3 {
                for k in 0..4 {
                    let by_two = plus_product::<FUSED>(block[r] * ways[k], block[3 + r], ways[4 + k]);
                    moved[4 * r + k] = plus_product::<FUSED>(by_two, block[6 + r], ways[8 + k]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Symmetric as a whole, and known by two names.
    fn block(i: usize, j: usize) -> DMat3 {
        let skew = DMat3::from_cols(DVec3::ZERO, DVec3::Z, -DVec3::Y) * (i as f64 - j as f64);
        DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)) * (1.0 + (i * j) as f64) + skew
    }

    #[test]
    fn slots_that_come_and_go_keep_what_is_between_them() {
        let (mut between, mut names) = (Between::default(), Vec::new());
        for name in 0..ROOM + 3 {
            names.push(name);
            between.enter(name, |slot| block(names[slot], name));
        }
        for slot in [5, 0, 100] {
            between.leave(slot, names.len() - 1);
            names.swap_remove(slot);
        }
        for (i, &name) in names.iter().enumerate() {
            for (j, &other) in names.iter().enumerate() {
                assert_eq!(between.block(i, j), block(name, other));
            }
        }
    }

    #[test]
    fn slots_move_by_a_shared_force_as_by_its_parts() {
        let mut between = Between::default();
        for new in 0..7 {
            between.enter(new, |slot| block(slot, new));
        }
        let ways = [DVec3::new(0.3, -1.0, 0.5), DVec3::Y, DVec3::NEG_X];
        let columns = DMat3::from_cols(ways[0], ways[1], ways[2]);
        let shares = [(2, 0.75), (5, -0.5), (0, 0.75)];
        let mut moved = Moved::default();
        between.move_by(&shares, &columns, 7, &mut moved);
        let moved = moved.slots;
        for (number, &way) in ways.iter().enumerate() {
            for (slot, moved) in moved.iter().enumerate() {
                let parts = shares.map(|(loaded, share)| block(slot, loaded) * way * share);
                let told = DVec3::from_array([0, 4, 8].map(|axis| moved[axis + number]));
                assert!(told.distance(parts.into_iter().sum()) < 1e-12);
            }
        }
        let (mut along, way) = (Vec::new(), ways[0]);
        let forces = shares.map(|(_, share)| (way * share).extend(0.0).to_array());
        between.move_along(&shares, &forces, 7, &mut along);
        for (along, moved) in along.iter().zip(&moved) {
            assert!((0..3).all(|axis| (along[axis] - moved[4 * axis]).abs() < 1e-12));
        }
    }
}
