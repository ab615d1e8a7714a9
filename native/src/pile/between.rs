//! How the contact points of a body that are looked at give way to forces on each other.

use glam::{DMat3, DVec3};

use crate::algebra::wide::{plus_product, widely};

/// Places at first.
const ROOM: usize = 128;

/// Three vectors one after the other, each with a place for a register's fourth number.
pub(super) type Three = [f64; 12];

/// Compliance between all slots, kept while they come and go: of each that is loaded a block for all
/// that are moved, column after column.
#[derive(Debug, Clone, Default)]
pub(super) struct Between {
    room: usize,
    blocks: Vec<Three>,
}

impl Between {
    /// How a slot moves by a force on another, m/N at unit modulus.
    fn block(&self, moved: usize, loaded: usize) -> DMat3 {
        let block = &self.blocks[loaded * self.room + moved];
        DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| block[4 * c + r])))
    }

    /// Takes down how a slot moves by a force on another, and the other way round.
    fn put(&mut self, moved: usize, loaded: usize, block: &DMat3) {
        let (there, back) = (loaded * self.room + moved, moved * self.room + loaded);
        for c in 0..3 {
            for r in 0..3 {
                self.blocks[there][4 * c + r] = block.col(c)[r];
                self.blocks[back][4 * r + c] = block.col(c)[r];
            }
        }
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
        let mut blocks = vec![[0.0; 12]; room * room];
        for slot in 0..slots {
            let from = &self.blocks[slot * self.room..][..slots];
            blocks[slot * room..][..slots].copy_from_slice(from);
        }
        (self.room, self.blocks) = (room, blocks);
    }

    /// How the first `count` slots move by a unit force along each of some ways, three at most, shared out
    /// among some; `sum` is memory.
    pub(super) fn move_by(
        &self,
        shares: &[(usize, f64)],
        ways: &[DVec3],
        count: usize,
        sum: &mut Vec<Three>,
        moved: &mut Vec<Three>,
    ) {
        let of = |slot: usize| &self.blocks[slot * self.room..][..count];
        moved.resize(count, [0.0; 12]);
        if let [(slot, 1.0)] = shares {
            turn(of(*slot), ways, moved);
            return;
        }
        sum.clear();
        sum.resize(count, [0.0; 12]);
        for &(slot, share) in shares {
            add(of(slot), share, sum);
        }
        turn(sum, ways, moved);
    }
}

widely! {
    /// Adds a share of blocks to others.
    fn add(blocks: &[Three], share: f64, sum: &mut [Three]) {
        for (sum, block) in sum.iter_mut().zip(blocks) {
            for k in 0..12 {
                sum[k] = plus_product::<FUSED>(sum[k], share, block[k]);
            }
        }
    }
}

widely! {
    /// What each block makes of each way.
    fn turn(blocks: &[Three], ways: &[DVec3], moved: &mut [Three]) {
        for (moved, block) in moved.iter_mut().zip(blocks) {
            for (way, moved) in ways.iter().zip(moved.chunks_exact_mut(4)) {
                for r in 0..4 {
                    let by_two = plus_product::<FUSED>(way.x * block[r], way.y, block[4 + r]);
                    moved[r] = plus_product::<FUSED>(by_two, way.z, block[8 + r]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
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
        let ways = [DVec3::new(0.3, -1.0, 0.5), DVec3::Y];
        let shares = [(2, 0.75), (5, -0.5), (0, 0.75)];
        let (mut sum, mut moved) = (Vec::new(), Vec::new());
        between.move_by(&shares, &ways, 7, &mut sum, &mut moved);
        for (number, &way) in ways.iter().enumerate() {
            for (slot, moved) in moved.iter().enumerate() {
                let parts = shares.map(|(loaded, share)| block(slot, loaded) * way * share);
                let told = DVec3::from_slice(&moved[4 * number..]);
                assert!(told.distance(parts.into_iter().sum()) < 1e-12);
            }
        }
    }
}
