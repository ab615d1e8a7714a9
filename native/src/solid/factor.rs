//! Cholesky factors by fronts, as `core/compliance/elimination/cholesky.py` makes them, for solves.

use super::domains::Nodal;
use super::four::{Four, ZERO};
use crate::algebra::wide::widely;

/// A front: its rows of R, with R'R the factored matrix.
#[derive(Debug, Clone, Copy)]
struct Front {
    /// First of its unknowns in the order of elimination, and how many.
    start: usize,
    size: usize,
    /// Where its other unknowns begin, and how many its rows reach.
    boundary: (usize, usize),
    /// Where its entries begin.
    entries: usize,
}

/// The factor of a symmetric positive definite matrix, in numbers of one precision.
#[derive(Debug, Clone)]
pub struct Factor<T> {
    /// The unknowns in order of elimination.
    order: Vec<u32>,
    fronts: Vec<Front>,
    boundaries: Vec<u32>,
    /// Of each front the rows, from the diagonal, there the inverse, over its own unknowns and its boundary.
    entries: Vec<T>,
}

impl<T> Factor<T> {
    /// A factor of fronts of so many unknowns that reach so many others, (`size`, `reach`) each; None where
    /// the arrays do not fit together.
    pub fn new(
        order: Vec<u32>,
        sizes: &[(usize, usize)],
        boundaries: Vec<u32>,
        entries: Vec<T>,
    ) -> Option<Self> {
        let (mut fronts, mut start, mut reached, mut taken) = (Vec::new(), 0, 0, 0);
        for &(size, reach) in sizes {
            fronts.push(Front {
                start,
                size,
                boundary: (reached, reach),
                entries: taken,
            });
            start += size;
            reached += reach;
            taken += size * (size + 1) / 2 + size * reach;
        }
        let count = order.len();
        let fits = (start, reached, taken) == (count, boundaries.len(), entries.len())
            && (order.iter().chain(&boundaries)).all(|&unknown| (unknown as usize) < count);
        fits.then_some(Self {
            order,
            fronts,
            boundaries,
            entries,
        })
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Room for the unknowns of a solve, and for those of one front.
    pub fn room<V: Copy + Default>(&self) -> Room<V> {
        let widest = self
            .fronts
            .iter()
            .map(|front| front.size + front.boundary.1);
        Room {
            held: vec![V::default(); self.len()],
            local: vec![V::default(); widest.max().unwrap_or(0)],
        }
    }

    /// Takes each front's unknowns through its rows, first to last and back.
    fn sweep<V: Copy>(
        &self,
        room: &mut Room<V>,
        down: impl Fn(&[T], &mut [V], usize),
        up: impl Fn(&[T], &mut [V], usize),
    ) {
        let Room { held, local } = room;
        for front in &self.fronts {
            let local = self.gather(front, held, local);
            down(self.rows(front), local, front.size);
            let (own, beyond) = local.split_at(front.size);
            held[front.start..front.start + front.size].copy_from_slice(own);
            for (value, &place) in beyond.iter().zip(self.beyond(front)) {
                held[place as usize] = *value;
            }
        }
        for front in self.fronts.iter().rev() {
            let local = self.gather(front, held, local);
            up(self.rows(front), local, front.size);
            held[front.start..front.start + front.size].copy_from_slice(&local[..front.size]);
        }
    }

    /// A front's own unknowns and its boundary's, side by side.
    fn gather<'a, V: Copy>(&self, front: &Front, held: &[V], local: &'a mut [V]) -> &'a mut [V] {
        let local = &mut local[..front.size + front.boundary.1];
        local[..front.size].copy_from_slice(&held[front.start..front.start + front.size]);
        for (value, &place) in local[front.size..].iter_mut().zip(self.beyond(front)) {
            *value = held[place as usize];
        }
        local
    }

    fn beyond(&self, front: &Front) -> &[u32] {
        let (first, reach) = front.boundary;
        &self.boundaries[first..first + reach]
    }

    fn rows(&self, front: &Front) -> &[T] {
        let size = front.size;
        let count = size * (size + 1) / 2 + size * front.boundary.1;
        &self.entries[front.entries..front.entries + count]
    }
}

/// Room for a solve.
#[derive(Debug, Clone)]
pub struct Room<V> {
    held: Vec<V>,
    local: Vec<V>,
}

impl Factor<f32> {
    /// Solves for freedoms, three a node.
    pub fn solve_freedoms(&self, right: &Nodal, room: &mut Room<f32>, solution: &mut Nodal) {
        let (right, solution) = (right.as_flattened(), solution.as_flattened_mut());
        // In units of the largest: single precision has few powers of ten.
        let largest = right.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let unit = if largest > 0.0 { largest } else { 1.0 };
        for (held, &from) in room.held.iter_mut().zip(&self.order) {
            *held = (right[from as usize] / unit) as f32;
        }
        self.sweep(room, down, up);
        for (&held, &to) in room.held.iter().zip(&self.order) {
            solution[to as usize] = f64::from(held) * unit;
        }
    }
}

impl Factor<f64> {
    /// Solves for nodes, the three axes alike.
    pub fn solve_axes(&self, right: &Nodal, room: &mut Room<Four>, solution: &mut Nodal) {
        for (held, &from) in room.held.iter_mut().zip(&self.order) {
            let [x, y, z] = right[from as usize];
            *held = Four([x, y, z, 0.0]);
        }
        self.sweep(room, axes_down, axes_up);
        for (&Four([x, y, z, _]), &to) in room.held.iter().zip(&self.order) {
            solution[to as usize] = [x, y, z];
        }
    }
}

/// Numbers added side by side in a dot product.
const LANES: usize = 16;

widely! {
    /// A front's part of R'^-1, by its rows.
    fn down(rows: &[f32], local: &mut [f32], size: usize) {
        let mut rows = rows;
        for pivot in 0..size {
            let (own, beyond) = local[pivot..].split_at_mut(1);
            let (row, rest) = rows.split_at(1 + beyond.len());
            own[0] *= row[0];
            for (value, entry) in beyond.iter_mut().zip(&row[1..]) {
                *value -= own[0] * entry;
            }
            rows = rest;
        }
    }
}

widely! {
    /// A front's part of R^-1, by its rows.
    fn up(rows: &[f32], local: &mut [f32], size: usize) {
        let mut rows = rows;
        for pivot in (0..size).rev() {
            let (own, beyond) = local[pivot..].split_at_mut(1);
            let (before, row) = rows.split_at(rows.len() - 1 - beyond.len());
            let mut sums = [0.0_f32; LANES];
            let whole = beyond.len() / LANES * LANES;
            for (values, entries) in (beyond[..whole].chunks_exact(LANES))
                .zip(row[1..=whole].chunks_exact(LANES))
            {
                for lane in 0..LANES {
                    sums[lane] += values[lane] * entries[lane];
                }
            }
            for (value, (entry, sum)) in (beyond[whole..].iter())
                .zip(row[1 + whole..].iter().zip(&mut sums))
            {
                *sum += value * entry;
            }
            // By halves: a long chain of sums would wait for each.
            let mut half = LANES / 2;
            while half > 0 {
                for lane in 0..half {
                    sums[lane] += sums[lane + half];
                }
                half /= 2;
            }
            own[0] = (own[0] - sums[0]) * row[0];
            rows = before;
        }
    }
}

widely! {
    /// As [`down`], for three axes at once.
    fn axes_down(rows: &[f64], local: &mut [Four], size: usize) {
        let mut rows = rows;
        for pivot in 0..size {
            let (own, beyond) = local[pivot..].split_at_mut(1);
            let (row, rest) = rows.split_at(1 + beyond.len());
            own[0] = own[0] * Four::all(row[0]);
            for (value, &entry) in beyond.iter_mut().zip(&row[1..]) {
                *value -= own[0] * Four::all(entry);
            }
            rows = rest;
        }
    }
}

widely! {
    /// As [`up`], for three axes at once.
    fn axes_up(rows: &[f64], local: &mut [Four], size: usize) {
        let mut rows = rows;
        for pivot in (0..size).rev() {
            let (own, beyond) = local[pivot..].split_at_mut(1);
            let (before, row) = rows.split_at(rows.len() - 1 - beyond.len());
            // Four sums: one would wait for itself.
            let mut sums = [ZERO; 4];
            let whole = beyond.len() / 4 * 4;
            for (values, entries) in (beyond[..whole].chunks_exact(4))
                .zip(row[1..=whole].chunks_exact(4))
            {
                sums[0] += values[0] * Four::all(entries[0]);
                sums[1] += values[1] * Four::all(entries[1]);
                sums[2] += values[2] * Four::all(entries[2]);
                sums[3] += values[3] * Four::all(entries[3]);
            }
            for (value, &entry) in beyond[whole..].iter().zip(&row[1 + whole..]) {
                sums[0] += *value * Four::all(entry);
            }
            let sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
            own[0] = (own[0] - sum) * Four::all(row[0]);
            rows = before;
        }
    }
}
