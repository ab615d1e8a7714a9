//! Energy and stress of strained places: the laws of `core/law/`, four places at a time.
//!
//! Both laws share what grows with the shear modulus, mu (|F|^2 / 2 - 3/2 - ln J); they differ in what
//! volume costs. Where a place has lost 95 % of its volume they go on as a parabola.

use super::four::{Four, Matrix, cofactors, dot, on_diagonal, plus, scaled, transposed};

/// Of a volume, about what nothing that is pressed comes to.
const FLATTEST: f64 = 0.05;
/// Up to this |x - 1| / (x + 1) the series of the logarithm is summed, to the last digit.
const NEAR: f64 = 0.03;

/// What a change of volume costs, per Lame's first parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// (J - 1)^2 / 2: rubber.
    NeoHookean,
    /// (J^e - 1 - e ln J) / e^2 with this exponent e, not zero: foam of one term with the exponent 2, whose
    /// Poisson's ratio nu stays the same under every load along an axis if e = -2 nu / (1 - 2 nu).
    Foam(f64),
}

/// Value and slope of a function.
type Sloped = (Four, Four);

impl Law {
    /// Energies and stresses (first Piola and Kirchhoff's) at displacement gradients `h`, by moduli that
    /// may be times volumes.
    #[inline(always)]
    pub fn stressed(self, h: &Matrix, first_lame: Four, shear: Four) -> (Four, Matrix) {
        let trace = h[0][0] + h[1][1] + h[2][2];
        let second = (h[0][0] * h[1][1] - h[0][1] * h[1][0])
            + (h[1][1] * h[2][2] - h[1][2] * h[2][1])
            + (h[2][2] * h[0][0] - h[2][0] * h[0][2]);
        let own = cofactors(h);
        let third = dot(&h[0], &own[0]);
        // J - 1, exact to rounding also where h is small.
        let excess = trace + second + third;
        let (held, held_slope) = barrier(excess);
        let (volume, volume_slope) = self.volume(excess);
        let square = dot(&h[0], &h[0]) + dot(&h[1], &h[1]) + dot(&h[2], &h[2]);
        let density =
            shear * (Four::all(0.5) * square - second - third + held) + first_lame * volume;
        // mu (F - cof F / J) without the difference of what is nearly alike.
        let minus_own = scaled(&own, Four::all(-1.0));
        let shape = plus(&plus(h, &transposed(h)), &minus_own);
        let shape = scaled(&on_diagonal(&shape, -trace), shear);
        let pressure = shear * held_slope + first_lame * volume_slope;
        let moved = cofactors(&on_diagonal(h, Four::all(1.0)));
        (density, plus(&shape, &scaled(&moved, pressure)))
    }

    #[inline(always)]
    fn volume(self, excess: Four) -> Sloped {
        match self {
            Law::NeoHookean => (Four::all(0.5) * excess * excess, excess),
            Law::Foam(exponent) => foam(excess, exponent),
        }
    }
}

/// J - 1 - ln J at J = 1 + excess.
#[inline(always)]
fn barrier(excess: Four) -> Sloped {
    let over = excess.at_least(FLATTEST - 1.0);
    let below = (excess - over).at_most(0.0);
    let share = Four::all(1.0) / (Four::all(1.0) + over);
    let (slope, curvature) = (over * share, share * share);
    let value = less_logarithm(over);
    (
        value + below * (slope + Four::all(0.5) * below * curvature),
        slope + below * curvature,
    )
}

/// Excess less ln(1 + excess).
#[inline(always)]
fn less_logarithm(excess: Four) -> Four {
    // ln x = 2 (z + z^3/3 + z^5/5 + ...), z = excess / (2 + excess); excess - 2 z = excess z.
    let z = excess / (Four::all(2.0) + excess);
    let square = z * z;
    let tail = square
        * (Four::all(1.0 / 3.0)
            + square
                * (Four::all(1.0 / 5.0)
                    + square * (Four::all(1.0 / 7.0) + square * Four::all(1.0 / 9.0))));
    let mut found = excess * z - Four::all(2.0) * z * tail;
    if z.largest() > NEAR {
        for lane in 0..4 {
            if z.0[lane].abs() > NEAR {
                found.0[lane] = excess.0[lane] - excess.0[lane].ln_1p();
            }
        }
    }
    found
}

/// (J^e - 1 - e ln J) / e^2 at J = 1 + excess.
#[inline(always)]
fn foam(excess: Four, e: f64) -> Sloped {
    let (mut value, mut slope) = (excess, excess);
    for lane in 0..4 {
        let over = excess.0[lane].max(FLATTEST - 1.0);
        let below = (excess.0[lane] - over).min(0.0);
        let (x, logarithm) = (1.0 + over, over.ln_1p());
        let grown = (e * logarithm).exp_m1();
        let first = grown / (e * x);
        // What is not convex there is driven back all the same.
        let second = (((e - 1.0) * grown + e) / (e * x * x)).max(0.0);
        value.0[lane] = (grown - e * logarithm) / (e * e) + below * (first + 0.5 * below * second);
        slope.0[lane] = first + below * second;
    }
    (value, slope)
}
