//! A = L L^T of a small symmetric positive definite matrix, in memory that is already there.

use super::wide::widely;
use super::{MOST_POINTS, room};

/// Sums that run beside each other, so that no addition waits for the one before.
const LANES: usize = 8;

/// A pivot below this share of its diagonal entry is rounding.
const LEAST_PIVOT: f64 = 1e-13;

/// The sum of products, in a fixed order of additions.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    let mut lanes = [0.0; LANES];
    let (heads_a, heads_b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let tail: f64 = (heads_a.remainder().iter())
        .zip(heads_b.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in heads_a.zip(heads_b) {
        for (lane, (x, y)) in lanes.iter_mut().zip(x.iter().zip(y)) {
            *lane += x * y;
        }
    }
    ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5]))
        + ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]))
        + tail
}

/// The lower factor, row by row.
#[derive(Debug, Clone)]
pub struct Factor {
    size: usize,
    rows: Vec<f64>,
    inverse_pivots: Vec<f64>,
}

impl Default for Factor {
    fn default() -> Self {
        Self {
            size: 0,
            rows: room(MOST_POINTS * MOST_POINTS),
            inverse_pivots: vec![0.0; MOST_POINTS],
        }
    }
}

impl Factor {
    /// Row `i`: the first i + 1 numbers of the matrix are to be put there, the factor's come out.
    #[inline]
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.rows[i * MOST_POINTS..][..MOST_POINTS]
    }

    /// Decomposes the matrix in the rows; false where it is not positive definite to rounding.
    pub fn decompose(&mut self, size: usize) -> bool {
        self.size = size;
        widely!(decompose(&mut self.rows, &mut self.inverse_pivots, size))
    }

    /// x with L x = b, in place of b.
    pub fn solve_lower(&self, b: &mut [f64]) {
        for i in 0..self.size {
            let row = &self.rows[i * MOST_POINTS..][..i];
            b[i] = (b[i] - dot(row, &b[..i])) * self.inverse_pivots[i];
        }
    }

    /// x with A x = b, in place of b.
    pub fn solve(&self, b: &mut [f64]) {
        self.solve_lower(b);
        for i in (0..self.size).rev() {
            b[i] *= self.inverse_pivots[i];
            let (rest, x) = b.split_at_mut(i);
            let row = &self.rows[i * MOST_POINTS..][..i];
            for (entry, l) in rest.iter_mut().zip(row) {
                *entry -= x[0] * l;
            }
        }
    }
}

/// Column after column: the entries of one do not wait for each other.
#[inline(always)]
fn decompose(rows: &mut [f64], inverse_pivots: &mut [f64], size: usize) -> bool {
    for j in 0..size {
        let (above, below) = rows.split_at_mut((j + 1) * MOST_POINTS);
        let here = &mut above[j * MOST_POINTS..][..=j];
        let (head, own) = here.split_at_mut(j);
        let pivot = own[0] - dot(head, head);
        // Not a number is not greater.
        let is_positive = pivot > LEAST_PIVOT * own[0] && pivot.is_finite();
        if !is_positive {
            return false;
        }
        own[0] = pivot.sqrt();
        inverse_pivots[j] = 1.0 / own[0];
        for other in below.chunks_exact_mut(MOST_POINTS).take(size - j - 1) {
            other[j] = (other[j] - dot(&other[..j], head)) * inverse_pivots[j];
        }
    }
    true
}
