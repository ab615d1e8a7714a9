//! A symmetric matrix of which each entry is told once, on either side of the diagonal.

use std::ops::Range;

/// Rows and columns that are looked at together: as many as lie in a line of a processor's cache.
const TILE: usize = 8;

/// Adds up what is below and above the diagonal of some rows and columns of a matrix with so many of each.
pub(super) fn add_mirrored(matrix: &mut [f64], range: Range<usize>, count: usize) {
    for row in range.clone().step_by(TILE) {
        for column in (range.start..=row).step_by(TILE) {
            if column < row && row + TILE <= range.end {
                add_tile(matrix, [row, column], count);
                continue;
            }
            for i in row..(row + TILE).min(range.end) {
                for j in column..(column + TILE).min(i) {
                    let sum = matrix[i * count + j] + matrix[j * count + i];
                    (matrix[i * count + j], matrix[j * count + i]) = (sum, sum);
                }
            }
        }
    }
}

/// The same of a tile that is wholly below the diagonal.
#[inline]
fn add_tile(matrix: &mut [f64], [row, column]: [usize; 2], count: usize) {
    let (above, below) = matrix.split_at_mut(row * count);
    for j in 0..TILE {
        let above = &mut above[(column + j) * count + row..][..TILE];
        for (i, entry) in above.iter_mut().enumerate() {
            let mirrored = &mut below[i * count + column + j];
            *entry += *mirrored;
            *mirrored = *entry;
        }
    }
}

/// Adds what is told in the first rows of all columns behind, turned over: to the first columns of these rows.
pub(super) fn add_turned(matrix: &mut [f64], first: usize, count: usize) {
    let (above, below) = matrix[..count * count].split_at_mut(first * count);
    for row in (first..count).step_by(TILE) {
        for column in (0..first).step_by(TILE) {
            for j in column..(column + TILE).min(first) {
                let told = &above[j * count..][..count];
                for i in row..(row + TILE).min(count) {
                    below[(i - first) * count + j] += told[i];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_turned_over_is_added() {
        const COUNT: usize = 21;
        for first in [0, 5, 10, COUNT] {
            let told: Vec<f64> = (0..COUNT * COUNT).map(|k| (k * k % 101) as f64).collect();
            let mut matrix = told.clone();
            add_turned(&mut matrix, first, COUNT);
            for (k, (&entry, &before)) in matrix.iter().zip(&told).enumerate() {
                let (i, j) = (k / COUNT, k % COUNT);
                let is_added = i >= first && j < first;
                let other = if is_added { told[j * COUNT + i] } else { 0.0 };
                assert_eq!(entry, before + other);
            }
        }
    }

    #[test]
    fn each_entry_is_what_was_told_on_both_sides() {
        const COUNT: usize = 19;
        for range in [0..COUNT, 3..17, 5..6, 7..7] {
            let told: Vec<f64> = (0..COUNT * COUNT).map(|k| (k * k % 101) as f64).collect();
            let mut matrix = told.clone();
            add_mirrored(&mut matrix, range.clone(), COUNT);
            for i in 0..COUNT {
                for j in 0..COUNT {
                    let is_other = range.contains(&i) && range.contains(&j) && i != j;
                    let other = if is_other { told[j * COUNT + i] } else { 0.0 };
                    assert_eq!(matrix[i * COUNT + j], told[i * COUNT + j] + other);
                }
            }
        }
    }
}
