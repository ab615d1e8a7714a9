//! A = L L^T by panels of columns: what a panel gives to the entries behind it is added along their rows,
//! so that no sum lies across a register (Golub and Van Loan 2013, 4.2.6).

use super::ROW;
use super::wide::{LANES, plus_product, widely};

/// A pivot below this share of its diagonal entry is rounding.
const LEAST_PIVOT: f64 = 1e-13;

/// Columns that are decomposed together.
const PANEL: usize = LANES;

/// Some columns of the factor, each contiguous, at the places of their rows.
type Panel = [[f64; ROW]; PANEL];

widely! {
    /// The factor's rows in place of the matrix's, of which the first i + 1 numbers of row i count, and
    /// the inverses of its pivots; false where the matrix is not positive definite to rounding.
    pub(super) fn decompose(rows: &mut [f64], inverse_pivots: &mut [f64], size: usize) -> bool {
        for (i, own) in inverse_pivots[..size].iter_mut().enumerate() {
            *own = rows[i * ROW + i];
        }
        let mut panel: Panel = [[0.0; ROW]; PANEL];
        for first in (0..size).step_by(PANEL) {
            let width = PANEL.min(size - first);
            for i in first..size {
                let row = &rows[i * ROW + first..][..width];
                for (column, entry) in panel.iter_mut().zip(row) {
                    column[i] = *entry;
                }
            }
            if !decompose_panel::<FUSED>(&mut panel[..width], inverse_pivots, first..size) {
                return false;
            }
            for i in first..size {
                let row = &mut rows[i * ROW + first..][..width.min(i - first + 1)];
                for (entry, column) in row.iter_mut().zip(&panel) {
                    *entry = column[i];
                }
            }
            let behind = first + PANEL;
            for i in behind..size {
                take_panel::<FUSED>(&mut rows[i * ROW..][..ROW], &panel, behind, i);
            }
        }
        true
    }
}

/// The square root of a pivot, if it is one.
#[inline(always)]
pub(super) fn root(own: f64, pivot: f64) -> Option<f64> {
    // Not a number is not greater.
    (pivot > LEAST_PIVOT * own && pivot.is_finite()).then(|| pivot.sqrt())
}

/// Decomposes columns from row `range.start` on; their upper triangle, which nobody reads, is filled
/// with anything. `pivots` holds the matrix's own diagonal before, and inverses after.
#[inline(always)]
fn decompose_panel<const FUSED: bool>(
    panel: &mut [[f64; ROW]],
    pivots: &mut [f64],
    range: std::ops::Range<usize>,
) -> bool {
    // Whole registers: behind the last row there is room.
    let end = range.start + (range.len().div_ceil(LANES) * LANES);
    for c in 0..panel.len() {
        let j = range.start + c;
        let (before, rest) = panel.split_at_mut(c);
        let column = &mut rest[0][range.start..end];
        for one in before.iter() {
            let share = -one[j];
            for (entry, l) in column.iter_mut().zip(&one[range.start..end]) {
                *entry = plus_product::<FUSED>(*entry, share, *l);
            }
        }
        let Some(pivot) = root(pivots[j], column[c]) else {
            return false;
        };
        let inverse = 1.0 / pivot;
        for entry in column.iter_mut() {
            *entry *= inverse;
        }
        (column[c], pivots[j]) = (pivot, inverse);
    }
    true
}

/// Takes what a panel gives out of the entries of row `i` from `behind` on; what lies behind the
/// diagonal, which nobody reads, is changed to the end of a register.
#[inline(always)]
fn take_panel<const FUSED: bool>(row: &mut [f64], panel: &Panel, behind: usize, i: usize) {
    let mut shares = [0.0; PANEL];
    for (share, column) in shares.iter_mut().zip(panel) {
        *share = -column[i];
    }
    for k in (behind..=i).step_by(LANES) {
        let to = &mut row[k..][..LANES];
        let mut sums = [0.0; LANES];
        sums.copy_from_slice(to);
        for (column, share) in panel.iter().zip(shares) {
            let from = &column[k..][..LANES];
            for l in 0..LANES {
                sums[l] = plus_product::<FUSED>(sums[l], share, from[l]);
            }
        }
        to.copy_from_slice(&sums);
    }
}
