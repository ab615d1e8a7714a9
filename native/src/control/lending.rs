//! What a body holds more because it has become firmer, which nobody has put in.

use super::firmness::Firmness;

/// What the linear contact holds in a body.
#[derive(Debug, Clone, Copy, Default)]
pub struct Held {
    /// J.
    pub energy: f64,
    /// The same at unit modulus, J/Pa.
    pub unit: f64,
    /// By how many times as far as what presses moves the body what it remembers does.
    pub remembered: f64,
}

/// How firm a body is from tick to tick.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lending {
    firmness: Firmness,
    /// That of the tick before.
    before: Firmness,
    /// What comes.
    told: Firmness,
    held: Held,
}

impl Lending {
    /// How firm it is in this tick.
    pub fn firmness(&self) -> &Firmness {
        &self.firmness
    }

    /// A tick of `dt` s nearer to a firmness; where that is none, linear at once.
    pub fn lead(&mut self, to: Option<&Firmness>, dt: f64) {
        self.before = self.firmness;
        let Some(to) = to else {
            (self.firmness, self.told) = (Firmness::default(), Firmness::default());
            return;
        };
        if *to != self.told {
            let now = self.held.unit * (1.0 + self.held.remembered).powi(2);
            (self.firmness, self.told) = (self.firmness.beside(to, now), *to);
        }
        if !self.firmness.is_linear() || !to.is_linear() {
            self.firmness.fade(to, dt);
        }
    }

    /// What another firmness has put into the body in this tick, at whose end it holds so much, J: half of it
    /// where fingers were, half where they are.
    pub fn lent(&mut self, now: Held) -> f64 {
        let last = std::mem::replace(&mut self.held, now);
        0.5 * (self.more(&now) + self.more(&last))
    }

    /// What it is more, J, that the body is as firm as now instead of as in the tick before.
    fn more(&self, of: &Held) -> f64 {
        let mean = |firmness: &Firmness| firmness.mean(of.unit, of.remembered);
        of.energy * (mean(&self.firmness) - mean(&self.before))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lent_is_what_the_body_holds_in_the_end_beyond_the_work_done() {
        let to = Firmness::through(&[(1.0, 1.3), (4.0, 1.8)]).unwrap();
        let mut lending = Lending::default();
        let held = |unit: f64| Held {
            energy: unit,
            unit,
            remembered: 0.0,
        };
        let (mut work, mut lent, mut unit) = (0.0, 0.0, 0.0);
        let mut at = 1.0;
        for tick in 1..=1000 {
            lending.lead(Some(&to), 1e-3);
            let next = 3.0 * (f64::from(tick) / 1000.0).powi(2);
            let now = lending.firmness().at(next);
            work += 0.5 * (at + now) * (next - unit);
            lent += lending.lent(held(next));
            (at, unit) = (now, next);
        }
        let all = unit * lending.firmness().mean(unit, 0.0);
        assert!(lent > 1e-4 * all);
        assert!(
            (work + lent - all).abs() < 1e-5 * all,
            "{work} {lent} {all}"
        );
        assert!(lending.lent(held(unit)).abs() < 1e-8);
        lending.lead(None, 1e-3);
        assert!(lending.firmness().is_linear());
        assert!(lending.lent(held(unit)) < 0.0);
    }
}
