//! Four numbers at once, and 3 x 3 matrices of them: four places of a body in one arithmetic.
//!
//! All of it is compiled with its caller, so that a loop compiled for wide registers
//! ([`widely`](crate::algebra::wide)) is wide throughout: no closure, no call.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Four numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(align(32))]
pub struct Four(pub [f64; 4]);

/// A vector of each of four places.
pub type Vector = [Four; 3];
/// A matrix of each of four places, by rows.
pub type Matrix = [[Four; 3]; 3];

/// Nothing, four times.
pub const ZERO: Four = Four([0.0; 4]);

macro_rules! four_by_four {
    ($trait:ident, $name:ident, $sign:tt) => {
        impl $trait for Four {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                let (a, b) = (self.0, other.0);
                Self([a[0] $sign b[0], a[1] $sign b[1], a[2] $sign b[2], a[3] $sign b[3]])
            }
        }
    };
}
four_by_four!(Add, add, +);
four_by_four!(Sub, sub, -);
four_by_four!(Mul, mul, *);
four_by_four!(Div, div, /);

impl Mul<f64> for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, by: f64) -> Self {
        self * Self::all(by)
    }
}

impl AddAssign for Four {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Four {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Four {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        ZERO - self
    }
}

impl Four {
    /// The same number four times.
    #[inline(always)]
    pub const fn all(x: f64) -> Self {
        Self([x; 4])
    }

    /// Each the larger of itself and a bound.
    #[inline(always)]
    pub fn at_least(self, least: f64) -> Self {
        let a = self.0;
        Self([
            a[0].max(least),
            a[1].max(least),
            a[2].max(least),
            a[3].max(least),
        ])
    }

    /// Each the smaller of itself and a bound.
    #[inline(always)]
    pub fn at_most(self, most: f64) -> Self {
        let a = self.0;
        Self([
            a[0].min(most),
            a[1].min(most),
            a[2].min(most),
            a[3].min(most),
        ])
    }

    /// The largest, without its sign.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        let a = self.0;
        (a[0].abs().max(a[1].abs())).max(a[2].abs().max(a[3].abs()))
    }

    /// All together.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let a = self.0;
        (a[0] + a[1]) + (a[2] + a[3])
    }
}

/// A + B.
#[inline(always)]
pub fn plus(a: &Matrix, b: &Matrix) -> Matrix {
    [
        [a[0][0] + b[0][0], a[0][1] + b[0][1], a[0][2] + b[0][2]],
        [a[1][0] + b[1][0], a[1][1] + b[1][1], a[1][2] + b[1][2]],
        [a[2][0] + b[2][0], a[2][1] + b[2][1], a[2][2] + b[2][2]],
    ]
}

/// A times a number.
#[inline(always)]
pub fn scaled(a: &Matrix, by: Four) -> Matrix {
    [
        [a[0][0] * by, a[0][1] * by, a[0][2] * by],
        [a[1][0] * by, a[1][1] * by, a[1][2] * by],
        [a[2][0] * by, a[2][1] * by, a[2][2] * by],
    ]
}

/// A + x I.
#[inline(always)]
pub fn on_diagonal(a: &Matrix, x: Four) -> Matrix {
    let mut found = *a;
    found[0][0] += x;
    found[1][1] += x;
    found[2][2] += x;
    found
}

/// Transposed A.
#[inline(always)]
pub fn transposed(a: &Matrix) -> Matrix {
    [
        [a[0][0], a[1][0], a[2][0]],
        [a[0][1], a[1][1], a[2][1]],
        [a[0][2], a[1][2], a[2][2]],
    ]
}

/// A row of A times B.
#[inline(always)]
fn row(a: &Vector, b: &Matrix) -> Vector {
    [
        a[0] * b[0][0] + a[1] * b[1][0] + a[2] * b[2][0],
        a[0] * b[0][1] + a[1] * b[1][1] + a[2] * b[2][1],
        a[0] * b[0][2] + a[1] * b[1][2] + a[2] * b[2][2],
    ]
}

/// A B.
#[inline(always)]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    [row(&a[0], b), row(&a[1], b), row(&a[2], b)]
}

/// (A + A') / 2.
#[inline(always)]
pub fn symmetric_part(a: &Matrix) -> Matrix {
    scaled(&plus(a, &transposed(a)), Four::all(0.5))
}

/// The vector w of A - A' = \[w\]x.
#[inline(always)]
pub fn axial(a: &Matrix) -> Vector {
    [a[2][1] - a[1][2], a[0][2] - a[2][0], a[1][0] - a[0][1]]
}

/// \[w\]x, so that \[w\]x a = w x a.
#[inline(always)]
pub fn cross_matrix(w: &Vector) -> Matrix {
    [
        [ZERO, -w[2], w[1]],
        [w[2], ZERO, -w[0]],
        [-w[1], w[0], ZERO],
    ]
}

/// a x b.
#[inline(always)]
pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// a . b.
#[inline(always)]
pub fn dot(a: &Vector, b: &Vector) -> Four {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cofactors, det A times the inverse transposed.
#[inline(always)]
pub fn cofactors(a: &Matrix) -> Matrix {
    [
        cross(&a[1], &a[2]),
        cross(&a[2], &a[0]),
        cross(&a[0], &a[1]),
    ]
}

/// Inverse of a symmetric A whose eigenvalues are 1 or more. So its determinant is at least 1 and no
/// entry of the inverse is larger, which rounding would not keep where eigenvalues differ by far.
#[inline(always)]
pub fn inverse_above_identity(a: &Matrix) -> Matrix {
    let rows = cofactors(a);
    let share = Four::all(1.0) / dot(&a[0], &rows[0]).at_least(1.0);
    let mut found = scaled(&rows, share);
    for row in &mut found {
        for entry in row {
            *entry = entry.at_least(-1.0).at_most(1.0);
        }
    }
    found
}
