//! How the contact points of a body that are looked at give way to forces on each other.

use glam::{DMat3, DVec3};

use crate::algebra::wide::{plus_product, widely};

/// Places at first, and behind the last one, so that rows do not all lie in the same sets of a cache.
const ROOM: usize = 128;
const BEHIND: usize = 8;

/// Compliance between all slots, kept while they come and go: nine rows a slot, of which each holds an
/// entry for all slots.
#[derive(Debug, Clone, Default)]
pub(super) struct Between {
    room: usize,
    numbers: Vec<f64>,
}

impl Between {
    /// From one row to the next.
    #[inline]
    pub(super) fn row(&self) -> usize {
        self.room + BEHIND
    }

    /// How all slots are moved along an axis by a force along an axis on one.
    #[inline]
    fn at(&self, loaded: usize, [along, moved]: [usize; 2]) -> usize {
        (9 * loaded + 3 * along + moved) * self.row()
    }

    /// How a slot moves by a force on another, m/N.
    pub(super) fn block(&self, moved: usize, loaded: usize) -> DMat3 {
        let entry = |c: usize, r: usize| self.numbers[self.at(loaded, [c, r]) + moved];
        DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| entry(c, r))))
    }

    /// Takes down how a slot moves by a force on another, and the other way round.
    fn put(&mut self, moved: usize, loaded: usize, block: &DMat3) {
        for c in 0..3 {
            for r in 0..3 {
                let (there, back) = (self.at(loaded, [c, r]), self.at(moved, [r, c]));
                self.numbers[there + moved] = block.col(c)[r];
                self.numbers[back + loaded] = block.col(c)[r];
            }
        }
    }

    /// Takes in a slot behind the last: how each up to it moves by a force on it, m/N.
    pub(super) fn enter(&mut self, new: usize, moves: impl Fn(usize) -> DMat3) {
        if new >= self.room {
            self.grow(new);
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

    fn grow(&mut self, slots: usize) {
        let room = (2 * self.room).max(ROOM);
        let mut grown = Self {
            room,
            numbers: vec![0.0; 9 * room * (room + BEHIND)],
        };
        for row in 0..9 * slots {
            let from = &self.numbers[row * self.row()..][..slots];
            let to = row * grown.row();
            grown.numbers[to..to + slots].copy_from_slice(from);
        }
        *self = grown;
    }

    /// How the first `count` slots move by a unit force along each of some ways, shared out among some:
    /// three rows a way, an axis each, as far apart as [`Self::row`] says.
    pub(super) fn move_by(
        &self,
        shares: &[(usize, f64)],
        ways: &[DVec3],
        count: usize,
        sum: &mut Vec<f64>,
        moved: &mut Vec<f64>,
    ) {
        let row = self.row();
        sum.resize(9 * row, 0.0);
        moved.resize(9 * row, 0.0);
        let summed = match shares {
            [(slot, share)] if *share == 1.0 => &self.numbers[9 * slot * row..],
            _ => {
                for (k, &(slot, share)) in shares.iter().enumerate() {
                    add(
                        &self.numbers[9 * slot * row..],
                        share,
                        k == 0,
                        row,
                        count,
                        sum,
                    );
                }
                &sum[..]
            }
        };
        turn(summed, ways, row, count, moved);
    }

    /// How a slot moves by a way's force, of the rows that [`Self::move_by`] has made.
    #[inline]
    pub(super) fn moved(&self, rows: &[f64], way: usize, slot: usize) -> DVec3 {
        let row = self.row();
        let at = |axis: usize| rows[(3 * way + axis) * row + slot];
        DVec3::new(at(0), at(1), at(2))
    }
}

widely! {
    /// Adds a share of nine rows to others, which are begun with the first.
    fn add(rows: &[f64], share: f64, is_first: bool, row: usize, count: usize, sum: &mut [f64]) {
        for k in 0..9 {
            let (from, to) = (&rows[k * row..][..count], &mut sum[k * row..][..count]);
            if is_first {
                for (to, from) in to.iter_mut().zip(from) {
                    *to = share * from;
                }
            } else {
                for (to, from) in to.iter_mut().zip(from) {
                    *to = plus_product::<FUSED>(*to, share, *from);
                }
            }
        }
    }
}

widely! {
    /// Three rows for each way: those of the axes, by the way's parts along these.
    fn turn(rows: &[f64], ways: &[DVec3], row: usize, count: usize, moved: &mut [f64]) {
        for (number, way) in ways.iter().enumerate() {
            for axis in 0..3 {
                let [x, y, z] = [0, 3, 6].map(|along: usize| &rows[(along + axis) * row..][..count]);
                let to = &mut moved[(3 * number + axis) * row..][..count];
                for s in 0..count {
                    let by_two = plus_product::<FUSED>(way.x * x[s], way.y, y[s]);
                    to[s] = plus_product::<FUSED>(by_two, way.z, z[s]);
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
            for slot in 0..7 {
                let parts = shares.map(|(loaded, share)| block(slot, loaded) * way * share);
                let told = between.moved(&moved, number, slot);
                assert!(told.distance(parts.into_iter().sum()) < 1e-12);
            }
        }
    }
}
