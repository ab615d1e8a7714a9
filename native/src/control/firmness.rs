//! How much more firmly a body of its material's law presses back than a linear one.
//!
//! Forces of the linear contact times G, a function of the elastic energy W that the linear contact holds
//! (at unit modulus, J/Pa):
//!
//! ```text
//! G(W) = 1 + root sqrt(W) + whole W          to W = reach, beyond which it stays
//! ```
//!
//! What is held is then the integral of G over W, a function of the fingers' poses alone, so that nothing is
//! gained at one place; small presses are linear. A body that gives way with time is as firm as where it is
//! now tells, whatever it remembers, and relaxes as a linear one (quasi-linear viscoelasticity: Y. C. Fung,
//! Biomechanics, 1993). Whoever relaxes the body under the forces of a touch finds
//! root and whole, in the background. They are faded in, and what that puts into the body the
//! [toll](super::toll) takes.

/// Bounds of what is felt.
const LEAST: f64 = 0.1;
const MOST: f64 = 30.0;
/// Another firmness is there within about this time, s.
const FADING: f64 = 0.05;
/// What adds less than this adds nothing.
const NONE: f64 = 1e-12;

/// Firmness of a touch; by default that of the linear body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Firmness {
    /// Per square root of J/Pa.
    pub root: f64,
    /// Per J/Pa.
    pub whole: f64,
    /// J/Pa.
    pub reach: f64,
}

impl Firmness {
    /// Whether it is that of the linear body.
    pub fn is_linear(&self) -> bool {
        *self == Self::default()
    }

    /// G where the linear contact holds so much, J/Pa.
    pub fn at(&self, energy: f64) -> f64 {
        let known = energy.clamp(0.0, self.reach);
        (1.0 + self.root * known.sqrt() + self.whole * known).clamp(LEAST, MOST)
    }

    /// The mean of G on the way out of a spring that holds so much, J/Pa: with it that is what is held. The
    /// body is moved by so many times as far besides as the spring is, which stays.
    pub fn mean(&self, energy: f64, remembered: f64) -> f64 {
        // 2 times the integral of G((s + r)^2 W) s ds from 0 to 1.
        let ([root, whole, s], r) = (self.on_the_way(energy, remembered), remembered);
        let known = s * s * (1.0 + root * (2.0 / 3.0 * s + r))
            + s * s * whole * (0.5 * s * s + 4.0 / 3.0 * r * s + r * r);
        known + self.at(self.reach) * (1.0 - s * s)
    }

    /// How much of what such a spring presses with is kept as what is remembered grows and it goes back: as a share
    /// of the force there.
    pub fn kept(&self, energy: f64, remembered: f64) -> f64 {
        let ([root, whole, s], r) = (self.on_the_way(energy, remembered), remembered);
        let grown = s * s * (0.5 * root + whole * (2.0 / 3.0 * s + r));
        grown / self.at(energy * (1.0 + r) * (1.0 + r))
    }

    /// Root and whole where the spring alone holds so much, and the share of its way within reach.
    fn on_the_way(&self, energy: f64, remembered: f64) -> [f64; 3] {
        let held = energy.max(0.0);
        let within = if held > 0.0 {
            ((self.reach / held).sqrt() - remembered).clamp(0.0, 1.0)
        } else {
            1.0
        };
        [self.root * held.sqrt(), self.whole * held, within]
    }

    /// By how much more steeply than firmly the force grows with the depth, 1 or more.
    pub fn steepness(&self, energy: f64) -> f64 {
        if energy >= self.reach {
            return 1.0;
        }
        let known = energy.max(0.0);
        let steep = 1.0 + 2.0 * self.root * known.sqrt() + 3.0 * self.whole * known;
        (steep / self.at(known)).max(1.0)
    }

    /// A tick of `dt` s nearer to another.
    ///
    /// What each adds at its own reach is what fades: of a shallow press the numbers themselves are those of a
    /// steep curve, which must not be followed to the reach of a deep one.
    #[must_use]
    pub fn faded(&self, to: &Self, dt: f64) -> Self {
        // A number also where the time between ticks is none or has no end.
        let share = 1.0 / (1.0 + FADING / dt);
        let between = |from: f64, to: f64| from + (to - from) * share;
        let at_reach = |one: &Self| (one.root * one.reach.sqrt(), one.whole * one.reach);
        let (from, end) = (at_reach(self), at_reach(to));
        let (root, whole) = (between(from.0, end.0), between(from.1, end.1));
        // A linear one is that to any depth.
        let reach = match (self.is_linear(), to.is_linear()) {
            (true, _) => to.reach,
            (_, true) => self.reach,
            _ => between(self.reach, to.reach),
        };
        if reach <= 0.0 || (to.is_linear() && root.abs() + whole.abs() <= NONE) {
            return *to;
        }
        Self {
            root: root / reach.sqrt(),
            whole: whole / reach,
            reach,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIRM: Firmness = Firmness {
        root: 0.2,
        whole: 0.1,
        reach: 4.0,
    };

    #[test]
    fn what_is_held_is_the_integral_of_the_firmness() {
        for most in [0.5, 3.9, 4.0, 9.0] {
            let steps = 100_000;
            let each = most / f64::from(steps);
            let middle = |k: u32| FIRM.at((f64::from(k) + 0.5) * each);
            let sum: f64 = (0..steps).map(middle).sum();
            assert!((sum * each / most - FIRM.mean(most, 0.0)).abs() < 1e-6);
        }
    }

    #[test]
    fn what_a_spring_holds_that_has_gone_back_is_its_work_on_the_way_out() {
        for (energy, remembered) in [(0.3, 0.5), (1.0, 2.0), (3.0, 0.1), (9.0, 0.4), (0.01, 30.0)] {
            let held = |r: f64, of: f64| {
                let steps = 20_000;
                let sum: f64 = (0..steps)
                    .map(|k| (f64::from(k) + 0.5) / f64::from(steps) * of)
                    .map(|s| FIRM.at(energy * (s + r) * (s + r)) * s)
                    .sum();
                2.0 * energy * sum * of / f64::from(steps)
            };
            let mean = FIRM.mean(energy, remembered);
            assert!((held(remembered, 1.0) / energy - mean).abs() < 1e-6 * mean);
            // Where the place stays, the spring goes back by what is remembered more.
            let more = 1e-4;
            let gone = held(remembered, 1.0) - held(remembered + more, 1.0 - more);
            let force = FIRM.at(energy * (1.0 + remembered).powi(2)) * 2.0 * energy;
            let lost = force * more * (1.0 - FIRM.kept(energy, remembered));
            assert!((gone - lost).abs() < 1e-3 * force * more, "{gone} {lost}");
        }
    }

    #[test]
    fn the_force_grows_as_steeply_as_is_told() {
        // The force goes with the depth s times G, and s with the root of the energy.
        let force = |s: f64| s * FIRM.at(s * s);
        for s in [0.1, 1.0, 1.9] {
            let slope = (force(s + 1e-6) - force(s - 1e-6)) / 2e-6;
            assert!((slope / FIRM.at(s * s) - FIRM.steepness(s * s)).abs() < 1e-6);
        }
        assert_eq!(FIRM.steepness(5.0), 1.0);
    }

    #[test]
    fn it_is_bounded_and_continuous_and_linear_at_first() {
        assert_eq!(FIRM.at(0.0), 1.0);
        assert!((FIRM.at(4.0 - 1e-9) - FIRM.at(4.0 + 1e-9)).abs() < 1e-8);
        let wild = Firmness {
            root: -100.0,
            whole: 1e3,
            reach: 1e9,
        };
        assert_eq!((wild.at(0.001), wild.at(1e6)), (LEAST, MOST));
        assert!(Firmness::default().is_linear());
        assert_eq!(Firmness::default().at(1.0), 1.0);
        assert_eq!(Firmness::default().mean(1.0, 0.0), 1.0);
    }

    #[test]
    fn between_two_of_them_it_is_never_beyond_both() {
        let shallow = Firmness {
            root: 0.002 / 1e-6,
            whole: -0.001 / 1e-12,
            reach: 1e-12,
        };
        let mut now = shallow;
        for _ in 0..500 {
            now = now.faded(&FIRM, 1e-3);
            for energy in [1e-13, 1e-6, 0.1, 4.0] {
                assert!(now.at(energy) > 1.0 - 1e-9 && now.at(energy) < FIRM.at(4.0));
            }
        }
        let mut back = FIRM;
        for _ in 0..100_000 {
            back = back.faded(&Firmness::default(), 1e-3);
            assert!(back.at(2.0) >= 1.0 && back.at(2.0) <= FIRM.at(4.0));
        }
        assert!(back.is_linear());
    }

    #[test]
    fn another_one_comes_within_some_ticks() {
        let mut now = Firmness::default();
        for _ in 0..50 {
            now = now.faded(&FIRM, 1e-3);
        }
        assert!(now.at(4.0) > 1.0 + 0.3 * (FIRM.at(4.0) - 1.0) && now.at(4.0) < FIRM.at(4.0));
    }
}
