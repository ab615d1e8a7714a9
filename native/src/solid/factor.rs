//! Cholesky factors by fronts, as `core/compliance/elimination/cholesky.py` makes them, for solves.

use std::ops::{Add, Mul, Sub};

use super::domains::Nodal;
use super::four::Four;
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

/// Pivots whose rows are taken together: what lies beyond them is read and written once for all.
const TOGETHER: usize = 4;

/// What rows of numbers `T` are multiplied with.
trait Unknown<T>:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<T, Output = Self>
{
}
impl Unknown<f32> for f32 {}
impl Unknown<f64> for Four {}

widely! {
    /// A front's part of R'^-1, by its rows.
    fn down(rows: &[f32], local: &mut [f32], size: usize) {
        eliminate(rows, local, size);
    }
}

widely! {
    /// The same for three axes at once.
    fn axes_down(rows: &[f64], local: &mut [Four], size: usize) {
        eliminate(rows, local, size);
    }
}

widely! {
    /// A front's part of R^-1, by its rows.
    fn up(rows: &[f32], local: &mut [f32], size: usize) {
        substitute::<f32, f32, 16>(rows, local, size);
    }
}

widely! {
    /// The same for three axes at once.
    fn axes_up(rows: &[f64], local: &mut [Four], size: usize) {
        substitute::<f64, Four, 4>(rows, local, size);
    }
}

#[inline(always)]
fn eliminate<T: Copy, V: Unknown<T>>(rows: &[T], local: &mut [V], size: usize) {
    let (mut rows, mut pivot) = (rows, 0);
    while pivot + TOGETHER <= size {
        let (own, beyond) = local[pivot..].split_at_mut(TOGETHER);
        let (a, rest) = rows.split_at(TOGETHER + beyond.len());
        let (b, rest) = rest.split_at(a.len() - 1);
        let (c, rest) = rest.split_at(a.len() - 2);
        let (d, rest) = rest.split_at(a.len() - 3);
        let w = own[0] * a[0];
        let x = (own[1] - w * a[1]) * b[0];
        let y = (own[2] - w * a[2] - x * b[1]) * c[0];
        let z = (own[3] - w * a[3] - x * b[2] - y * c[1]) * d[0];
        own.copy_from_slice(&[w, x, y, z]);
        let (a, b, c, d) = (&a[4..], &b[3..], &c[2..], &d[1..]);
        for ((((value, &a), &b), &c), &d) in beyond.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *value = *value - ((w * a + x * b) + (y * c + z * d));
        }
        (rows, pivot) = (rest, pivot + TOGETHER);
    }
    for pivot in pivot..size {
        let (own, beyond) = local[pivot..].split_at_mut(1);
        let (row, rest) = rows.split_at(1 + beyond.len());
        own[0] = own[0] * row[0];
        for (value, &entry) in beyond.iter_mut().zip(&row[1..]) {
            *value = *value - own[0] * entry;
        }
        rows = rest;
    }
}

/// With so many sums side by side: a long chain would wait for each.
#[inline(always)]
fn substitute<T: Copy, V: Unknown<T>, const SUMS: usize>(rows: &[T], local: &mut [V], size: usize) {
    let mut rows = rows;
    for pivot in (0..size).rev() {
        let (own, beyond) = local[pivot..].split_at_mut(1);
        let (before, row) = rows.split_at(rows.len() - 1 - beyond.len());
        let mut sums = [V::default(); SUMS];
        let whole = beyond.len() / SUMS * SUMS;
        for (values, entries) in
            (beyond[..whole].chunks_exact(SUMS)).zip(row[1..=whole].chunks_exact(SUMS))
        {
            for lane in 0..SUMS {
                sums[lane] = sums[lane] + values[lane] * entries[lane];
            }
        }
        for (value, (&entry, sum)) in
            (beyond[whole..].iter()).zip(row[1 + whole..].iter().zip(&mut sums))
        {
            *sum = *sum + *value * entry;
        }
        let mut half = SUMS / 2;
        while half > 0 {
            for lane in 0..half {
                sums[lane] = sums[lane] + sums[lane + half];
            }
            half /= 2;
        }
        own[0] = (own[0] - sums[0]) * row[0];
        rows = before;
    }
}
