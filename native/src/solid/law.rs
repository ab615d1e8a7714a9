//! Energy and stress of strained places: the laws of `core/law/`, four places at a time.
//!
//! All of them are sums of what each principal stretch costs, per shear modulus, and of what a change of
//! volume costs, per Lame's first parameter. Rubber and Blatz' and Ko's foam know their stretches by their
//! squares alone, mu (|F|^2 / 2 - 3/2 - ln J), which takes no eigenvectors. Where a place has lost 95 % of its
//! volume, or of a length, it goes on as a parabola.

mod powers;
mod principal;

use self::powers::{FLATTEST, Powers};
use super::four::{Four, Matrix, cofactors, dot, on_diagonal, plus, scaled, transposed};

/// Up to this |x - 1| / (x + 1) the series of the logarithm is summed, to the last digit.
const NEAR: f64 = 0.03;

/// Of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// What stretches cost, per shear modulus; nothing where their squares do, as in rubber.
    stretches: Option<Powers>,
    /// What a change of volume costs, per Lame's first parameter; nothing where it is (J - 1)^2 / 2.
    volume: Option<Powers>,
}

/// The neo-Hookean law.
impl Default for Law {
    fn default() -> Self {
        Self {
            stretches: None,
            volume: None,
        }
    }
}

/// Value and slope of a function.
type Sloped = (Four, Four);

impl Law {
    /// The law whose stretches and volume cost such powers, shares and exponents, with no volume's where
    /// there are none; `is_straight` where what is pulled goes on as a parabola from rest. Nothing where
    /// there are too many powers, or what is no number.
    pub fn of(stretches: &[(f64, f64)], volume: &[(f64, f64)], is_straight: bool) -> Option<Self> {
        let powers = |given: &[(f64, f64)]| Powers::of(given, is_straight);
        let squares = stretches == [(1.0, 2.0)] && !is_straight;
        Some(Self {
            stretches: if squares {
                None
            } else {
                Some(powers(stretches).filter(|_| !stretches.is_empty())?)
            },
            volume: if volume.is_empty() {
                None
            } else {
                Some(powers(volume)?)
            },
        })
    }

    /// Energies and stresses (first Piola and Kirchhoff's) at displacement gradients `h`, by moduli that
    /// may be times volumes.
    #[inline(always)]
    pub fn stressed(&self, h: &Matrix, first_lame: Four, shear: Four) -> (Four, Matrix) {
        let trace = h[0][0] + h[1][1] + h[2][2];
        let second = (h[0][0] * h[1][1] - h[0][1] * h[1][0])
            + (h[1][1] * h[2][2] - h[1][2] * h[2][1])
            + (h[2][2] * h[0][0] - h[2][0] * h[0][2]);
        let own = cofactors(h);
        let third = dot(&h[0], &own[0]);
        // J - 1, exact to rounding also where h is small.
        let excess = trace + second + third;
        let (volume, volume_slope) = self.volume(excess, first_lame);
        let moved = cofactors(&on_diagonal(h, Four::all(1.0)));
        if let Some(powers) = &self.stretches {
            let (along, shape) = principal::stressed(powers, h, excess, shear);
            let pressed = scaled(&moved, first_lame * volume_slope);
            return (shear * along + first_lame * volume, plus(&shape, &pressed));
        }
        let (held, held_slope) = barrier(excess);
        let square = dot(&h[0], &h[0]) + dot(&h[1], &h[1]) + dot(&h[2], &h[2]);
        let density =
            shear * (Four::all(0.5) * square - second - third + held) + first_lame * volume;
        // mu (F - cof F / J) without the difference of what is nearly alike.
        let minus_own = scaled(&own, Four::all(-1.0));
        let shape = plus(&plus(h, &transposed(h)), &minus_own);
        let shape = scaled(&on_diagonal(&shape, -trace), shear);
        let pressure = shear * held_slope + first_lame * volume_slope;
        (density, plus(&shape, &scaled(&moved, pressure)))
    }

    /// What a volume 1 + excess costs, half of what a stretch does.
    #[inline(always)]
    fn volume(&self, excess: Four, first_lame: Four) -> Sloped {
        let Some(powers) = &self.volume else {
            return (Four::all(0.5) * excess * excess, excess);
        };
        let (mut value, mut slope) = (excess, excess);
        for lane in 0..4 {
            // Domains of shear have no modulus of volume.
            if first_lame.0[lane] != 0.0 {
                let (one, its_slope) = powers.sloped(excess.0[lane]);
                (value.0[lane], slope.0[lane]) = (0.5 * one, 0.5 * its_slope);
            }
        }
        (value, slope)
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
