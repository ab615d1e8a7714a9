//! A = L U of a square matrix, with row exchanges (G. H. Golub, C. F. Van Loan: Matrix Computations, 4th edition,
//! 2013, section 3.4), column after column, so that all sums are of rows and columns that lie in memory.

use crate::algebra::cholesky::dot;

/// The factors.
#[derive(Debug, Clone, Default)]
pub struct LowerUpper {
    size: usize,
    /// By rows, with a diagonal of ones that is not stored.
    lower: Vec<f64>,
    /// By columns.
    upper: Vec<f64>,
    /// Which row of the matrix came to each place.
    order: Vec<usize>,
}

impl LowerUpper {
    /// Factors a matrix that `write` puts into its columns, which are zeros before.
    pub fn fill(&mut self, size: usize, write: impl FnOnce(&mut [f64])) {
        self.size = size;
        self.order = (0..size).collect();
        for part in [&mut self.lower, &mut self.upper] {
            part.clear();
            part.resize(size * size, 0.0);
        }
        write(&mut self.upper);
        let mut own = vec![0.0; size];
        for column in 0..size {
            let from = column * size;
            for (value, &row) in own.iter_mut().zip(&self.order) {
                *value = self.upper[from + row];
            }
            for row in 1..size {
                let known = row.min(column);
                let less = dot(&self.lower[row * size..row * size + known], &own[..known]);
                own[row] -= less;
            }
            self.exchange(column, &mut own);
            let pivot = own[column];
            for (below, part) in own[column + 1..].iter().enumerate() {
                self.lower[(column + 1 + below) * size + column] = part / pivot;
            }
            self.upper[from..=from + column].copy_from_slice(&own[..=column]);
        }
    }

    /// What the matrix makes `asked` of; as many numbers as it has rows.
    pub fn solved(&self, asked: &[f64]) -> Vec<f64> {
        let size = self.size;
        let mut found: Vec<f64> = self.order.iter().map(|&row| asked[row]).collect();
        for row in 0..size {
            found[row] -= dot(&self.lower[row * size..row * size + row], &found[..row]);
        }
        for column in (0..size).rev() {
            let own = &self.upper[column * size..=column * size + column];
            found[column] /= own[column];
            let share = found[column];
            for (one, above) in found[..column].iter_mut().zip(own) {
                *one -= share * above;
            }
        }
        found
    }

    /// Brings the largest number from the diagonal on to it.
    fn exchange(&mut self, column: usize, own: &mut [f64]) {
        let size = self.size;
        let best = (column..size)
            .max_by(|&a, &b| own[a].abs().total_cmp(&own[b].abs()))
            .unwrap_or(column);
        if best == column {
            return;
        }
        own.swap(column, best);
        self.order.swap(column, best);
        let (before, after) = self.lower.split_at_mut(best * size);
        before[column * size..column * size + column].swap_with_slice(&mut after[..column]);
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
        let mut factor = LowerUpper::default();
        factor.fill(4, |rows| rows.copy_from_slice(columns.as_flattened()));
        let asked = [1.0, -2.0, 0.5, 3.0];
        let found = factor.solved(&asked);
        for row in 0..4 {
            let made: f64 = (0..4).map(|one| columns[one][row] * found[one]).sum();
            assert!((made - asked[row]).abs() < 1e-12);
        }
    }
}
