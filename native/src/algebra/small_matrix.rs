//! Symmetric positive definite matrices of a few rows, on the stack.

use glam::{DMat3, DVec3};

/// Rows at most.
pub const MOST_ROWS: usize = 15;

/// A square matrix of up to [`MOST_ROWS`] rows.
#[derive(Debug, Clone, Copy)]
pub struct SmallMatrix {
    rows: usize,
    entries: [[f64; MOST_ROWS]; MOST_ROWS],
}

/// The lower factor of Cholesky's factorisation, with the reciprocals of its diagonal.
#[derive(Debug, Clone, Copy)]
pub struct Factored {
    lower: SmallMatrix,
    reciprocals: [f64; MOST_ROWS],
}

impl SmallMatrix {
    /// Nothing but zeros.
    pub fn zero(rows: usize) -> Self {
        assert!(rows <= MOST_ROWS, "{rows}");
        Self {
            rows,
            entries: [[0.0; MOST_ROWS]; MOST_ROWS],
        }
    }

    /// Sets nine entries.
    pub fn put(&mut self, row: usize, column: usize, block: &DMat3) {
        for (k, line) in self.entries[row..row + 3].iter_mut().enumerate() {
            line[column..column + 3].copy_from_slice(&block.row(k).to_array());
        }
    }

    /// Nine entries.
    pub fn block(&self, row: usize, column: usize) -> DMat3 {
        let line = |k: usize| DVec3::from_slice(&self.entries[row + k][column..]);
        DMat3::from_cols(line(0), line(1), line(2)).transpose()
    }

    /// Cholesky's factor; only the lower half is read. `None` unless positive definite.
    pub fn factored(mut self) -> Option<Factored> {
        let mut reciprocals = [0.0; MOST_ROWS];
        for row in 0..self.rows {
            for column in 0..=row {
                let mut sum = self.entries[row][column];
                for k in 0..column {
                    sum -= self.entries[row][k] * self.entries[column][k];
                }
                if column < row {
                    self.entries[row][column] = sum * reciprocals[column];
                } else if sum > 0.0 && sum.is_finite() {
                    self.entries[row][row] = sum.sqrt();
                    reciprocals[row] = 1.0 / self.entries[row][row];
                } else {
                    return None;
                }
            }
        }
        Some(Factored {
            lower: self,
            reciprocals,
        })
    }

    /// Replaces the right hand side by the solution, by Gauss' elimination with row exchanges; for
    /// matrices that are not symmetric. `None` for a singular one.
    pub fn eliminate(mut self, column: &mut [f64; MOST_ROWS]) -> Option<()> {
        let rows = self.rows;
        for k in 0..rows {
            let size = |row: usize| self.entries[row][k].abs();
            let pivot = (k..rows).fold(
                k,
                |best, row| if size(row) > size(best) { row } else { best },
            );
            let is_sound = size(pivot) > 0.0 && size(pivot).is_finite();
            if !is_sound {
                return None;
            }
            self.entries.swap(k, pivot);
            column.swap(k, pivot);
            for row in k + 1..rows {
                let factor = self.entries[row][k] / self.entries[k][k];
                for c in k..rows {
                    self.entries[row][c] -= factor * self.entries[k][c];
                }
                column[row] -= factor * column[k];
            }
        }
        for row in (0..rows).rev() {
            let line = &self.entries[row];
            let known: f64 = (row + 1..rows).map(|c| line[c] * column[c]).sum();
            column[row] = (column[row] - known) / line[row];
        }
        Some(())
    }
}

impl Factored {
    /// Replaces the right hand side by the solution.
    pub fn solve(&self, column: &mut [f64; MOST_ROWS]) {
        let (rows, lower) = (self.lower.rows, &self.lower.entries);
        for row in 0..rows {
            let mut sum = column[row];
            for k in 0..row {
                sum -= lower[row][k] * column[k];
            }
            column[row] = sum * self.reciprocals[row];
        }
        for row in (0..rows).rev() {
            let mut sum = column[row];
            for k in row + 1..rows {
                sum -= lower[k][row] * column[k];
            }
            column[row] = sum * self.reciprocals[row];
        }
    }

    /// The inverse.
    pub fn inverse(&self) -> SmallMatrix {
        let mut inverse = SmallMatrix::zero(self.lower.rows);
        for k in 0..self.lower.rows {
            let mut column = [0.0; MOST_ROWS];
            column[k] = 1.0;
            self.solve(&mut column);
            for (row, entry) in inverse.entries.iter_mut().zip(column) {
                row[k] = entry;
            }
        }
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solution_and_inverse_fulfil_their_equations() {
        for rows in [3, 6, 15] {
            // Hilbert's, with a diagonal that keeps it from being too near to singular.
            let mut matrix = SmallMatrix::zero(rows);
            for i in 0..rows {
                for j in 0..rows {
                    let extra = f64::from(u8::from(i == j));
                    matrix.entries[i][j] = 1.0 / (1 + i + j) as f64 + extra;
                }
            }
            let factored = matrix.factored().expect("definite");
            let mut x = [0.0; MOST_ROWS];
            x[..rows].fill(1.0);
            factored.solve(&mut x);
            let inverse = factored.inverse();
            let mut y = [0.0; MOST_ROWS];
            y[..rows].fill(1.0);
            let mut skew = matrix;
            // Needs its rows exchanged.
            skew.entries.swap(0, rows - 1);
            skew.eliminate(&mut y).expect("regular");
            assert!(x.iter().zip(y).all(|(x, y)| (x - y).abs() < 1e-13));
            for i in 0..rows {
                let product = |column: &dyn Fn(usize) -> f64| -> f64 {
                    (0..rows).map(|k| matrix.entries[i][k] * column(k)).sum()
                };
                assert!((product(&|k| x[k]) - 1.0).abs() < 1e-13);
                for j in 0..rows {
                    let unit = f64::from(u8::from(i == j));
                    assert!((product(&|k| inverse.entries[k][j]) - unit).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn blocks_come_out_as_they_were_put() {
        let block = DMat3::from_cols_array(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        let mut matrix = SmallMatrix::zero(6);
        matrix.put(3, 0, &block);
        assert_eq!(matrix.block(3, 0), block);
        assert_eq!(matrix.entries[4][0], 2.0);
    }

    #[test]
    fn what_is_not_definite_has_no_factor() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut matrix = SmallMatrix::zero(3);
            matrix.put(0, 0, &DMat3::from_diagonal(DVec3::new(1.0, bad, 1.0)));
            assert!(matrix.factored().is_none(), "{bad}");
        }
    }
}
