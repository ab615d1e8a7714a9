//! A = L L^T of a small symmetric positive definite matrix, in memory that is already there; kept up
//! to date while rows come and go (Golub and Van Loan 2013, 6.5.4).

use std::hint::black_box;
use std::ops::Range;

use super::panels::{self, root};
use super::{MOST_POINTS, ROW, room};
use crate::algebra::wide::{LANES, plus_product, widely};

widely! {
    /// The sum of products, in a fixed order of additions.
    pub fn dot(a: &[f64], b: &[f64]) -> f64 {
        dot_within::<FUSED>(a, b)
    }
}

/// The same within a loop that is compiled for wide registers.
#[inline(always)]
pub(crate) fn dot_within<const FUSED: bool>(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    let mut lanes = [0.0; LANES];
    let mut k = 0;
    while k + LANES <= n {
        let (x, y) = (&a[k..k + LANES], &b[k..k + LANES]);
        for l in 0..LANES {
            lanes[l] = plus_product::<FUSED>(lanes[l], x[l], y[l]);
        }
        k += LANES;
    }
    total::<FUSED>(&lanes, &a[k..], &b[k..])
}

/// The sum of the lanes, and of products of what was too short for them.
#[inline(always)]
pub(crate) fn total<const FUSED: bool>(lanes: &[f64; LANES], a: &[f64], b: &[f64]) -> f64 {
    let mut tail = 0.0;
    for k in 0..a.len().min(b.len()) {
        tail = plus_product::<FUSED>(tail, a[k], b[k]);
    }
    let mut halves = [0.0; LANES / 2];
    for (k, half) in halves.iter_mut().enumerate() {
        *half = lanes[k] + lanes[k + LANES / 2];
    }
    // What is beside each other in a register is not added until the end. Out of the compiler's sight: from
    // the last sum back it would take lanes for pairs, and whole loops to registers half as wide.
    let halves = black_box(halves);
    ((halves[0] + halves[2]) + (halves[1] + halves[3])) + tail
}

/// The sums of products of three rows with one, each as [`dot_within`] has it, to the bit: what is loaded of
/// the one serves all.
#[inline(always)]
fn dots<const FUSED: bool>(rows: [&[f64]; 3], head: &[f64]) -> [f64; 3] {
    let n = head.len();
    let rows = rows.map(|row| &row[..n]);
    let mut lanes = [[0.0; LANES]; 3];
    let mut k = 0;
    while k + LANES <= n {
        let y = &head[k..k + LANES];
        for r in 0..3 {
            let x = &rows[r][k..k + LANES];
            for l in 0..LANES {
                lanes[r][l] = plus_product::<FUSED>(lanes[r][l], x[l], y[l]);
            }
        }
        k += LANES;
    }
    let mut sums = [0.0; 3];
    for r in 0..3 {
        sums[r] = total::<FUSED>(&lanes[r], &rows[r][k..], &head[k..]);
    }
    sums
}

/// The lower factor, row by row.
#[derive(Debug, Clone)]
pub struct Factor {
    size: usize,
    rows: Vec<f64>,
    inverse_pivots: Vec<f64>,
    /// The column of a row that goes.
    column: Vec<f64>,
}

impl Default for Factor {
    fn default() -> Self {
        Self {
            size: 0,
            rows: room(MOST_POINTS * ROW),
            inverse_pivots: vec![0.0; MOST_POINTS],
            column: vec![0.0; MOST_POINTS],
        }
    }
}

impl Factor {
    /// Row `i`: the first i + 1 numbers of the matrix are to be put there, the factor's come out.
    #[inline]
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.rows[i * ROW..][..MOST_POINTS]
    }

    /// Decomposes the matrix in the rows; false where it is not positive definite to rounding.
    pub fn decompose(&mut self, size: usize) -> bool {
        self.size = size;
        panels::decompose(&mut self.rows, &mut self.inverse_pivots, size)
    }

    /// Takes in the row that was put behind the last; false, and all as before, where the matrix with
    /// it is not positive definite to rounding.
    pub fn append(&mut self) -> bool {
        let (rows, inverse_pivots, size) = (&mut self.rows, &mut self.inverse_pivots, self.size);
        let done = append(rows, inverse_pivots, size);
        self.size += usize::from(done);
        done
    }

    /// Lets row and column `k` of the matrix go; those behind move up.
    pub fn remove(&mut self, k: usize) {
        for i in k + 1..self.size {
            let (above, here) = self.rows.split_at_mut(i * ROW);
            let up = &mut above[(i - 1) * ROW..];
            self.column[i - 1] = here[k];
            up[..k].copy_from_slice(&here[..k]);
            up[k..i].copy_from_slice(&here[k + 1..=i]);
        }
        self.size -= 1;
        // What the column gave to the rows behind, turned into them: a plane rotation for each.
        for m in k..self.size {
            let (own, gone) = (self.rows[m * ROW + m], self.column[m]);
            let pivot = (own * own + gone * gone).sqrt();
            let (cosine, sine) = (own / pivot, gone / pivot);
            self.rows[m * ROW + m] = pivot;
            self.inverse_pivots[m] = 1.0 / pivot;
            for i in m + 1..self.size {
                let (entry, gone) = (&mut self.rows[i * ROW + m], &mut self.column[i]);
                (*entry, *gone) = (
                    cosine * *entry + sine * *gone,
                    cosine * *gone - sine * *entry,
                );
            }
        }
    }

    /// x with L x = b, in place of b.
    pub fn solve_lower(&self, b: &mut [f64]) {
        solve_lower(&self.rows, &self.inverse_pivots, self.size, b);
    }

    /// The same for three columns that are zero before row `first`.
    pub fn solve_lower_three(&self, columns: &mut [[f64; MOST_POINTS]; 3], first: usize) {
        solve_lower_three(&self.rows, &self.inverse_pivots, first..self.size, columns);
    }

    /// x with A x = b, in place of b.
    pub fn solve(&self, b: &mut [f64]) {
        self.solve_lower(b);
        solve_upper(&self.rows, &self.inverse_pivots, self.size, b);
    }
}

widely! {
    fn solve_lower(rows: &[f64], inverse_pivots: &[f64], size: usize, b: &mut [f64]) {
        for i in 0..size {
            let row = &rows[i * ROW..][..i];
            b[i] = (b[i] - dot_within::<FUSED>(row, &b[..i])) * inverse_pivots[i];
        }
    }
}

widely! {
    fn solve_lower_three(
        rows: &[f64],
        inverse_pivots: &[f64],
        range: Range<usize>,
        columns: &mut [[f64; MOST_POINTS]; 3],
    ) {
        let first = range.start;
        for i in range {
            let row = &rows[i * ROW..][first..i];
            let [x, y, z] = [0, 1, 2].map(|k: usize| &columns[k][first..i]);
            let sums = dots::<FUSED>([x, y, z], row);
            for (column, sum) in columns.iter_mut().zip(sums) {
                column[i] = (column[i] - sum) * inverse_pivots[i];
            }
        }
    }
}

widely! {
    fn solve_upper(rows: &[f64], inverse_pivots: &[f64], size: usize, b: &mut [f64]) {
        for i in (0..size).rev() {
            b[i] *= inverse_pivots[i];
            let (rest, x) = b.split_at_mut(i);
            let row = &rows[i * ROW..][..i];
            for (entry, l) in rest.iter_mut().zip(row) {
                *entry = plus_product::<FUSED>(*entry, -x[0], *l);
            }
        }
    }
}

widely! {
    fn append(rows: &mut [f64], inverse_pivots: &mut [f64], size: usize) -> bool {
        let (above, row) = rows.split_at_mut(size * ROW);
        for (j, before) in above.chunks_exact(ROW).enumerate() {
            row[j] = (row[j] - dot_within::<FUSED>(&row[..j], &before[..j])) * inverse_pivots[j];
        }
        let (head, own) = row.split_at_mut(size);
        let Some(pivot) = root(own[0], own[0] - dot_within::<FUSED>(head, head)) else {
            return false;
        };
        (own[0], inverse_pivots[size]) = (pivot, 1.0 / pivot);
        true
    }
}
