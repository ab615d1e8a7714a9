//! Rotations from rotation vectors, and how a rotation changes with its vector, four at a time.
//!
//! The exponential map and its Jacobian: e.g. E. Eade, Lie Groups for 2D and 3D Transformations, 2017,
//! section 3.

use super::four::{Four, Matrix, Vector, cross, cross_matrix, dot, on_diagonal, plus, scaled};

/// Below this angle squared the closed form of the third coefficient loses digits, and four terms of
/// its series do not.
const SERIES_BELOW: f64 = 0.05;
/// Angles below count as this one, where nothing differs any more.
const SMALLEST_ANGLE: f64 = 1e-150;

/// Rotations by the length of each vector about its direction.
#[derive(Debug, Clone, Copy, Default)]
pub struct Turns {
    vectors: Vector,
    /// Angle squared, sin t / t and (1 - cos t) / t^2.
    squared: Four,
    sine: Four,
    versine: Four,
}

impl Turns {
    /// Of vectors, rad.
    #[inline(always)]
    pub fn of(vectors: Vector) -> Self {
        let squared = dot(&vectors, &vectors);
        let (mut chord, mut sine) = (squared, squared);
        for lane in 0..4 {
            let half = 0.5 * squared.0[lane].sqrt().max(SMALLEST_ANGLE);
            let (sin, cos) = half.sin_cos();
            chord.0[lane] = sin / half;
            sine.0[lane] = cos * sin / half;
        }
        Self {
            vectors,
            squared,
            sine,
            versine: Four::all(0.5) * chord * chord,
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
        let turned = plus(&outer, &scaled(&cross_matrix(w), self.sine));
        on_diagonal(&turned, -(self.squared * self.versine))
    }

    /// J' a for a = `turns`, where R' dR = \[J dw\]x as the vector w changes by dw.
    #[inline(always)]
    pub fn pulled_back(&self, turns: &Vector) -> Vector {
        let one = Four::all(1.0);
        let s = self.squared.at_most(SERIES_BELOW);
        let mut third = (one
            - s / Four::all(20.0)
                * (one
                    - s / Four::all(42.0)
                        * (one - s / Four::all(72.0) * (one - s / Four::all(110.0)))))
            / Four::all(6.0);
        if self.squared.largest() >= SERIES_BELOW {
            for lane in 0..4 {
                if self.squared.0[lane] >= SERIES_BELOW {
                    third.0[lane] = (1.0 - self.sine.0[lane]) / self.squared.0[lane];
                }
            }
        }
        let across = cross(&self.vectors, turns);
        let twice = cross(&self.vectors, &across);
        [
            turns[0] + self.versine * across[0] + third * twice[0],
            turns[1] + self.versine * across[1] + third * twice[1],
            turns[2] + self.versine * across[2] + third * twice[2],
        ]
    }
}
