//! Energy and stress of a law by principal stretches: F = U l V', U and V turns.

use super::powers::Powers;
use crate::solid::four::{Four, Matrix, plus, product, transposed};

/// Turns of two axes in one round of Jacobi's method, and rounds: of three axes six are far more than enough.
const PLANES: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];
const MOST_ROUNDS: usize = 8;
/// What is left of the diagonal, squared, as a share of the whole, where it ends.
const DIAGONAL: f64 = 1e-30;
/// Stretches shorter than this are told by the volume: their square has lost its digits.
const SHORT: f64 = 0.03;

/// Energies per shear modulus, and stresses of `shear`, at displacement gradients `h` whose determinant is
/// 1 + `excess`.
#[inline(always)]
pub(super) fn stressed(powers: &Powers, h: &Matrix, excess: Four, shear: Four) -> (Four, Matrix) {
    // F'F - I, exact to rounding also where h is small.
    let small = plus(&plus(h, &transposed(h)), &product(&transposed(h), h));
    let (squares, axes) = diagonalized(small);
    let mut energy = Four::default();
    let mut stress = [[Four::default(); 3]; 3];
    for lane in 0..4 {
        if shear.0[lane] == 0.0 {
            continue;
        }
        let squares = squares.map(|one| one.0[lane]);
        let of = |matrix: &Matrix| matrix.map(|row| row.map(|one| one.0[lane]));
        let one = Principal::of(&of(h), squares, &of(&axes), excess.0[lane]);
        for (axis, &own) in one.excess.iter().enumerate() {
            let (value, slope) = powers.sloped(own);
            energy.0[lane] += value;
            let (u, v) = (one.left[axis], one.right[axis]);
            for i in 0..3 {
                for j in 0..3 {
                    stress[i][j].0[lane] += shear.0[lane] * slope * u[i] * v[j];
                }
            }
        }
    }
    (energy, stress)
}

/// One place.
struct Principal {
    /// Stretches less 1; of what is inside out the least stretch is negative.
    excess: [f64; 3],
    left: [[f64; 3]; 3],
    right: [[f64; 3]; 3],
}

impl Principal {
    /// Of a gradient, stretches' squares less 1 and the axes of F'F in the columns of `axes`.
    fn of(h: &[[f64; 3]; 3], squares: [f64; 3], axes: &[[f64; 3]; 3], excess: f64) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| squares[b].total_cmp(&squares[a]));
        let axis = |k: usize| [axes[0][k], axes[1][k], axes[2][k]];
        let (first, second) = (axis(order[0]), axis(order[1]));
        let right = [first, second, cross(&first, &second)];
        let moved = |v: &[f64; 3]| {
            [0, 1, 2].map(|i| v[i] + h[i][0] * v[0] + h[i][1] * v[1] + h[i][2] * v[2])
        };
        let u = unit(moved(&first), &[1.0, 0.0, 0.0]);
        let w = moved(&second);
        let along = dot(&u, &w);
        let v = unit([0, 1, 2].map(|i| w[i] - along * u[i]), &any_across(&u));
        let left = [u, v, cross(&u, &v)];
        // Of l^2 - 1, where l is not short.
        let own = |k: usize| {
            let square = squares[order[k]].max(-1.0);
            square / (1.0 + (1.0 + square).sqrt())
        };
        let (longest, middle) = (own(0), own(1));
        let mut least = own(2);
        if excess <= SHORT - 1.0 || least <= SHORT - 1.0 {
            least = dot(&left[2], &moved(&right[2])) - 1.0;
        }
        Self {
            excess: [longest, middle, least],
            left,
            right,
        }
    }
}

/// Eigenvalues and axes (in columns) of symmetric matrices, by Jacobi's method.
#[inline(always)]
fn diagonalized(mut a: Matrix) -> ([Four; 3], Matrix) {
    let (one, none) = (Four::all(1.0), Four::default());
    let mut axes = [[one, none, none], [none, one, none], [none, none, one]];
    for _ in 0..MOST_ROUNDS {
        let aside = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
        let whole = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2] + aside;
        if (aside - whole * Four::all(DIAGONAL))
            .at_least(0.0)
            .largest()
            == 0.0
        {
            break;
        }
        for (p, q) in PLANES {
            turn(&mut a, &mut axes, p, q);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], axes)
}

/// The turn of two axes that takes away what couples them.
#[inline(always)]
fn turn(a: &mut Matrix, axes: &mut Matrix, p: usize, q: usize) {
    let (mut cosine, mut sine) = (Four::all(1.0), Four::default());
    for lane in 0..4 {
        let coupled = 2.0 * a[p][q].0[lane];
        let apart = a[q][q].0[lane] - a[p][p].0[lane];
        if coupled != 0.0 {
            let tangent = coupled / (apart.abs() + (apart * apart + coupled * coupled).sqrt())
                * apart.signum();
            cosine.0[lane] = 1.0 / (1.0 + tangent * tangent).sqrt();
            sine.0[lane] = tangent * cosine.0[lane];
        }
    }
    // A becomes J' A J, J the turn; the axes V J.
    for row in a.iter_mut().chain(axes) {
        let (x, y) = (row[p], row[q]);
        (row[p], row[q]) = (cosine * x - sine * y, sine * x + cosine * y);
    }
    let (x, y) = (a[p], a[q]);
    for (column, (x, y)) in x.into_iter().zip(y).enumerate() {
        a[p][column] = cosine * x - sine * y;
        a[q][column] = sine * x + cosine * y;
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Of a length of 1, or another where it has none.
fn unit(a: [f64; 3], other: &[f64; 3]) -> [f64; 3] {
    let length = dot(&a, &a).sqrt();
    if length > f64::MIN_POSITIVE {
        a.map(|x| x / length)
    } else {
        *other
    }
}

/// Some axis across one of length 1.
fn any_across(a: &[f64; 3]) -> [f64; 3] {
    let mut least = 0;
    for axis in 1..3 {
        if a[axis].abs() < a[least].abs() {
            least = axis;
        }
    }
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let across = cross(a, &other);
    let length = dot(&across, &across).sqrt();
    across.map(|x| x / length)
}
