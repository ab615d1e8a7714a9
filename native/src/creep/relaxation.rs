//! How a material relaxes, and how it creeps: the same, told the other way round.

use super::step::Step;
use super::term::{MOST_TERMS, Term};

/// Halvings of an interval in which a rate is sought.
const HALVINGS: usize = 200;

/// Compliance in time: J(t) = (1 + sum of share (1 - e^(-t / seconds))) / E_0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Creep {
    terms: [Term; MOST_TERMS],
    /// E_0 over the modulus in the end, less one.
    more: f64,
}

impl Creep {
    /// The creep of a material whose modulus relaxes by these terms. `None` for more than
    /// [`MOST_TERMS`], for shares that are negative, times that are not positive or not told apart,
    /// and anything that is no number.
    ///
    /// Both are one fraction of polynomials in the Laplace transform: the rates of creep are the
    /// zeros of the relaxation's, one below the slowest of its rates and one between any two.
    pub fn of(relaxation: &[Term]) -> Option<Self> {
        let is_sound =
            |term: &&Term| term.share.is_finite() && term.share >= 0.0 && term.seconds.is_normal();
        if relaxation.iter().filter(is_sound).count() != relaxation.len() {
            return None;
        }
        let mut terms: Vec<Term> = relaxation
            .iter()
            .copied()
            .filter(|t| t.share > 0.0)
            .collect();
        terms.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        let are_apart = terms
            .windows(2)
            .all(|pair| pair[0].seconds > pair[1].seconds);
        if terms.len() > MOST_TERMS || !are_apart || terms.iter().any(|t| t.seconds < 0.0) {
            return None;
        }
        let more: f64 = terms.iter().map(|term| term.share).sum();
        let mut creep = Self {
            more,
            ..Self::default()
        };
        let mut low = 0.0;
        for (found, term) in creep.terms.iter_mut().zip(&terms) {
            let high = 1.0 / term.seconds;
            let rate = zero_between(low, high, &terms);
            let slope: f64 = (terms.iter())
                .map(|t| t.share * t.seconds / (1.0 - rate * t.seconds).powi(2))
                .sum();
            *found = Term {
                share: (1.0 + more) / (rate * slope),
                seconds: 1.0 / rate,
            };
            low = high;
        }
        Some(creep)
    }

    /// Whether the body answers at once and for good.
    pub fn is_none(&self) -> bool {
        self.more == 0.0
    }

    /// What it does in a tick of `dt` s.
    pub fn step(&self, dt: f64) -> Step {
        Step::new(&self.terms, self.more, dt)
    }
}

/// Where 1 - sum of s r t / (1 - r t), which falls from above zero to below, is zero.
fn zero_between(mut low: f64, mut high: f64, terms: &[Term]) -> f64 {
    for _ in 0..HALVINGS {
        let rate = 0.5 * (low + high);
        let left: f64 = (terms.iter())
            .map(|t| t.share * rate * t.seconds / (1.0 - rate * t.seconds))
            .sum();
        if left < 1.0 {
            low = rate;
        } else {
            high = rate;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn term(share: f64, seconds: f64) -> Term {
        Term { share, seconds }
    }

    #[test]
    fn a_standard_linear_solid_creeps_more_slowly_than_it_relaxes() {
        let creep = Creep::of(&[term(1.5, 0.2)]).unwrap();
        assert!((creep.terms[0].share - 1.5).abs() < 1e-12);
        assert!((creep.terms[0].seconds - 0.5).abs() < 1e-12);
        assert!(!creep.is_none() && Creep::of(&[]).unwrap().is_none());
    }

    #[test]
    fn creep_and_relaxation_are_inverse_at_any_rate() {
        let terms = [term(0.8, 0.03), term(0.5, 4.0), term(0.3, 0.4)];
        let creep = Creep::of(&terms).unwrap();
        for p in [1e-3, 0.1, 1.0, 7.0, 300.0, 1e5] {
            let modulus: f64 = 1.0
                + (terms.iter())
                    .map(|t| t.share * p * t.seconds / (1.0 + p * t.seconds))
                    .sum::<f64>();
            let compliance: f64 = 1.0
                + (creep.terms.iter())
                    .map(|t| t.share / (1.0 + p * t.seconds))
                    .sum::<f64>();
            assert!((modulus * compliance / 2.6 - 1.0).abs() < 1e-12, "{p}");
        }
    }

    #[test]
    fn what_is_no_series_is_refused() {
        let refused = [
            vec![term(-0.1, 1.0)],
            vec![term(0.1, 0.0)],
            vec![term(0.1, -1.0)],
            vec![term(f64::NAN, 1.0)],
            vec![term(0.1, f64::INFINITY)],
            vec![term(0.1, 1.0), term(0.2, 1.0)],
            (1..=4).map(|k| term(0.1, f64::from(k))).collect(),
        ];
        for terms in refused {
            assert_eq!(Creep::of(&terms), None, "{terms:?}");
        }
    }
}
