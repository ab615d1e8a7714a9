//! What a stretch costs by a sum of powers of it, each less its part in a change of volume.

/// Of a volume or a length, about what nothing that is pressed comes to.
pub(super) const FLATTEST: f64 = 0.05;
/// Powers of one law at most.
const MOST: usize = 3;

/// The sum of s 2/a^2 (x^a - 1 - a ln x) over shares s and exponents a; twice what its curvature 2 at rest
/// would be of a square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Powers {
    terms: [(f64, f64); MOST],
    count: usize,
    /// Whether what is longer than at rest goes on as the parabola there.
    is_straight: bool,
}

impl Powers {
    /// Of at most three shares and exponents, none of these zero.
    pub(super) fn of(given: &[(f64, f64)], is_straight: bool) -> Option<Self> {
        let is_sound = |&(share, exponent): &(f64, f64)| {
            share.is_finite() && exponent.is_finite() && exponent != 0.0
        };
        if given.len() > MOST || !given.iter().all(is_sound) {
            return None;
        }
        let mut terms = [(0.0, 1.0); MOST];
        terms[..given.len()].copy_from_slice(given);
        Some(Self {
            terms,
            count: given.len(),
            is_straight,
        })
    }

    /// Value and slope at x = 1 + excess.
    #[inline]
    pub(super) fn sloped(&self, excess: f64) -> (f64, f64) {
        if self.is_straight && excess > 0.0 {
            let whole: f64 = self.terms[..self.count].iter().map(|term| term.0).sum();
            return (whole * excess * excess, 2.0 * whole * excess);
        }
        let over = excess.max(FLATTEST - 1.0);
        let below = (excess - over).min(0.0);
        let (x, logarithm) = (1.0 + over, over.ln_1p());
        let (mut value, mut slope) = (0.0, 0.0);
        for &(share, a) in &self.terms[..self.count] {
            let grown = (a * logarithm).exp_m1();
            let factor = 2.0 * share / (a * a);
            let first = factor * a * grown / x;
            value += factor * (grown - a * logarithm);
            slope += first;
            if below < 0.0 {
                // What is not convex there is driven back all the same.
                let second = (factor * a * ((a - 1.0) * grown + a) / (x * x)).max(0.0);
                value += below * (first + 0.5 * below * second);
                slope += below * second;
            }
        }
        (value, slope)
    }
}
