//! Rotations from rotation vectors, and how a rotation changes with its vector, four at a time.
//!
//! The exponential map and its Jacobian: e.g. E. Eade, Lie Groups for 2D and 3D Transformations, 2017,
//! section 3.

use super::four::{Four, Matrix, Vector, cross, cross_matrix, dot, on_diagonal, plus, scaled};

/// Below this angle squared the coefficients are sums of their series, to the last digit: the closed form
/// of the third one loses digits there, and a sine for each place costs more than all else.
const SERIES_BELOW: f64 = 0.5;
/// One over what each term of (t - sin t) / t^3 times 6, and of (1 - cos t) / t^2 times 2, divides by.
const THIRD: [f64; 7] = reciprocals([20.0, 42.0, 72.0, 110.0, 156.0, 210.0, 272.0]);
const VERSINE: [f64; 7] = reciprocals([12.0, 30.0, 56.0, 90.0, 132.0, 182.0, 240.0]);

/// Rotations by the length of each vector about its direction.
#[derive(Debug, Clone, Copy, Default)]
pub struct Turns {
    vectors: Vector,
    /// Angle squared, (1 - cos t) / t^2 and (t - sin t) / t^3.
    squared: Four,
    versine: Four,
    third: Four,
}

impl Turns {
    /// Of vectors, rad.
    #[inline(always)]
    pub fn of(vectors: Vector) -> Self {
        let squared = dot(&vectors, &vectors);
        let small = squared.at_most(SERIES_BELOW);
        let mut versine = Four::all(0.5) * alternating(small, &VERSINE);
        let mut third = Four::all(1.0 / 6.0) * alternating(small, &THIRD);
        if squared.largest() >= SERIES_BELOW {
            for lane in 0..4 {
                let square = squared.0[lane];
                if square >= SERIES_BELOW {
                    let half = 0.5 * square.sqrt();
                    let (sin, cos) = half.sin_cos();
                    versine.0[lane] = 2.0 * sin * sin / square;
                    third.0[lane] = (1.0 - cos * sin / half) / square;
                }
            }
        }
        Self {
            vectors,
            squared,
            versine,
            third,
        }
    }

    /// R - I.
    #[inline(always)]
    pub fn less_identity(&self) -> Matrix {
        let w = &self.vectors;
        let s = [
            w[0] * self.versine,
            w[1] * self.versine,
            w[2] * self.versine,
        ];
        let outer = [
            [s[0] * w[0], s[0] * w[1], s[0] * w[2]],
            [s[1] * w[0], s[1] * w[1], s[1] * w[2]],
            [s[2] * w[0], s[2] * w[1], s[2] * w[2]],
        ];
        let sine = Four::all(1.0) - self.squared * self.third;
        let turned = plus(&outer, &scaled(&cross_matrix(w), sine));
        on_diagonal(&turned, -(self.squared * self.versine))
    }

    /// J' a for a = `turns`, where R' dR = \[J dw\]x as the vector w changes by dw.
    #[inline(always)]
    pub fn pulled_back(&self, turns: &Vector) -> Vector {
        let across = cross(&self.vectors, turns);
        let twice = cross(&self.vectors, &across);
        [
            turns[0] + self.versine * across[0] + self.third * twice[0],
            turns[1] + self.versine * across[1] + self.third * twice[1],
            turns[2] + self.versine * across[2] + self.third * twice[2],
        ]
    }
}

/// 1 - s a (1 - s b (1 - ...)) for the numbers a, b, ...
#[inline(always)]
fn alternating(s: Four, numbers: &[f64; 7]) -> Four {
    let mut sum = Four::all(1.0);
    for &number in numbers.iter().rev() {
        sum = Four::all(1.0) - s * Four::all(number) * sum;
    }
    sum
}

const fn reciprocals(numbers: [f64; 7]) -> [f64; 7] {
    let mut found = numbers;
    let mut at = 0;
    while at < found.len() {
        found[at] = 1.0 / found[at];
        at += 1;
    }
    found
}
