//! P A = L U of a square matrix, with row exchanges, panel by panel (G. H. Golub, C. F. Van Loan: Matrix
//! Computations, 4th edition, 2013, section 3.4), so that nearly all of the work is products of matrices.

use matrixmultiply::dgemm;

/// Columns of a panel.
const PANEL: usize = 32;

/// The factors.
#[derive(Debug, Clone, Default)]
pub struct LowerUpper {
    size: usize,
    /// By columns: U, and below its diagonal L, whose own is of ones.
    both: Vec<f64>,
    /// Which row of the matrix came to each place.
    order: Vec<usize>,
}

impl LowerUpper {
    /// Factors a matrix that `write` puts into its columns, which are zeros before.
    pub fn fill(&mut self, size: usize, write: impl FnOnce(&mut [f64])) {
        self.size = size;
        self.order = (0..size).collect();
        self.both.clear();
        self.both.resize(size * size, 0.0);
        write(&mut self.both);
        for first in (0..size).step_by(PANEL) {
            let end = size.min(first + PANEL);
            for column in first..end {
                self.eliminate(column, first..column, size);
                self.exchange(column);
                let own = &mut self.both[column * size..][..size];
                let pivot = own[column];
                for below in &mut own[column + 1..] {
                    *below /= pivot;
                }
            }
            for column in end..size {
                self.eliminate(column, first..end, end);
            }
            self.take_products(first, end);
        }
    }

    /// What the matrix makes `asked` of; as many numbers as it has rows.
    pub fn solved(&self, asked: &[f64]) -> Vec<f64> {
        let size = self.size;
        let mut found: Vec<f64> = self.order.iter().map(|&row| asked[row]).collect();
        for column in 0..size {
            let (known, below) = found.split_at_mut(column + 1);
            let own = &self.both[column * size..][column + 1..size];
            take(known[column], own, below);
        }
        for column in (0..size).rev() {
            let own = &self.both[column * size..=column * size + column];
            let (above, known) = found.split_at_mut(column);
            known[0] /= own[column];
            take(known[0], &own[..column], above);
        }
        found
    }

    /// Takes what columns `by` of L make of a column of U from that, down to the row `end`.
    fn eliminate(&mut self, column: usize, by: std::ops::Range<usize>, end: usize) {
        let size = self.size;
        let (before, own) = self.both.split_at_mut(column * size);
        for one in by {
            let (known, below) = own[..end].split_at_mut(one + 1);
            take(known[one], &before[one * size..][one + 1..end], below);
        }
    }

    /// Takes from what is right of a panel and below it what the rows and columns between make.
    fn take_products(&mut self, first: usize, end: usize) {
        let (size, left) = (self.size, self.size - end);
        if left == 0 {
            return;
        }
        let (step, all) = (size as isize, self.both.as_mut_ptr());
        // SAFETY: rows and columns `end..size` of the square are written, those `first..end` left of and above
        // it read; all lie within `both`, and no number is of two of the three.
        unsafe {
            let lower = all.add(first * size + end);
            let upper = all.add(end * size + first);
            let rest = all.add(end * size + end);
            let depth = end - first;
            dgemm(
                left, depth, left, -1.0, lower, 1, step, upper, 1, step, 1.0, rest, 1, step,
            );
        }
    }

    /// Brings the largest number of a column, from the diagonal on, to it.
    fn exchange(&mut self, column: usize) {
        let size = self.size;
        let own = &self.both[column * size..][..size];
        let best = (column..size)
            .max_by(|&a, &b| own[a].abs().total_cmp(&own[b].abs()))
            .unwrap_or(column);
        if best == column {
            return;
        }
        self.order.swap(column, best);
        for one in self.both.chunks_exact_mut(size) {
            one.swap(column, best);
        }
    }
}

fn take(share: f64, column: &[f64], from: &mut [f64]) {
    for (one, part) in from.iter_mut().zip(column) {
        *one -= share * part;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_it_solves_is_what_the_matrix_makes_of_it() {
        // Column by column; its first pivot is none.
        let columns = [
            [0.0, 2.0, -1.0, 4.0],
            [3.0, 0.5, 0.0, -2.0],
            [1.0, -3.0, 2.0, 0.25],
            [-1.0, 0.0, 6.0, 5.0],
        ];
        solves(4, columns.as_flattened());
    }

    #[test]
    fn so_it_is_of_many_panels_and_of_a_part_of_one() {
        for size in [1, PANEL - 1, PANEL, PANEL + 1, 3 * PANEL + 7] {
            // No diagonal outweighs the rest, so rows are exchanged.
            let numbers =
                (0..size * size).map(|one| ((one * one * 7919 + 31 * one + 1) as f64).sin());
            solves(size, &numbers.collect::<Vec<_>>());
        }
    }

    fn solves(size: usize, columns: &[f64]) {
        let mut factor = LowerUpper::default();
        factor.fill(size, |rows| rows.copy_from_slice(columns));
        let asked: Vec<f64> = (0..size).map(|one| (one as f64).cos()).collect();
        let found = factor.solved(&asked);
        for row in 0..size {
            let made: f64 = (0..size)
                .map(|one| columns[one * size + row] * found[one])
                .sum();
            assert!((made - asked[row]).abs() < 1e-9, "{size} {row} {made}");
        }
    }
}
