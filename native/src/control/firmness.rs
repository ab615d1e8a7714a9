//! How much more firmly a body of its material's law presses back than a linear one.
//!
//! Forces of the linear contact times G, a function of the elastic energy W that the linear contact holds
//! (at unit modulus, J/Pa): 1 at no energy, known at some [`Knot`]s, straight between them over the depth
//! sqrt(W), and beyond the last as there.
//!
//! What is held is then the integral of G over W, a function of the fingers' poses alone, so that nothing is
//! gained at one place; small presses are linear. A body that gives way with time is as firm as where it is
//! now tells, whatever it remembers, and relaxes as a linear one (quasi-linear viscoelasticity: Y. C. Fung,
//! Biomechanics, 1993). Whoever relaxes the body under the forces of a touch finds the knots, in the
//! background. They are faded in, and what that puts into the body the [toll](super::toll) takes.

/// Bounds of what is felt.
const LEAST: f64 = 0.1;
const MOST: f64 = 30.0;
/// Another firmness is there within about this time, s.
const FADING: f64 = 0.05;
/// What adds less than this adds nothing.
const NONE: f64 = 1e-12;
/// So many knots are told at most.
pub const MOST_KNOTS: usize = 32;
/// Knots of what was told before that are kept while another fades in: those nearest to the press.
const KEPT: usize = MOST_KNOTS - 1;
/// Knots nearer to another than by this share of their depth are that.
const APART: f64 = 1e-3;

/// G at a depth, the root of J/Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    depth: f64,
    share: f64,
    /// Integrals of G over the depth to here, and of G times the depth.
    sums: [f64; 2],
}

const NOWHERE: Knot = Knot {
    depth: 0.0,
    share: 1.0,
    sums: [0.0; 2],
};

/// Firmness of a touch; by default that of the linear body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Firmness {
    /// Of the knots; those behind them are nowhere.
    count: usize,
    /// The first at no depth.
    knots: [Knot; 1 + MOST_KNOTS + KEPT],
}

impl Default for Firmness {
    fn default() -> Self {
        Self {
            count: 1,
            knots: [NOWHERE; 1 + MOST_KNOTS + KEPT],
        }
    }
}

impl Firmness {
    /// Through G at ascending energies, J/Pa, above zero; none where they are not, or too many.
    pub fn through(known: &[(f64, f64)]) -> Option<Self> {
        let ascend = known.windows(2).all(|two| two[0].0 < two[1].0);
        let are_finite = (known.iter()).all(|&(energy, share)| {
            energy.is_normal() && energy > 0.0 && energy.is_finite() && share.is_finite()
        });
        (ascend && are_finite && known.len() <= MOST_KNOTS).then(|| {
            Self::of(
                (known.iter()).map(|&(energy, share)| (energy.sqrt(), share.clamp(LEAST, MOST))),
            )
        })
    }

    /// Through G at ascending depths.
    fn of(known: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut made = Self::default();
        for (depth, share) in known {
            made.knots[made.count] = Knot {
                depth,
                share,
                ..NOWHERE
            };
            made.count += 1;
        }
        made.sum_up();
        made
    }

    fn sum_up(&mut self) {
        for k in 1..self.count {
            self.knots[k].sums = self.sums(k - 1, self.knots[k].depth);
        }
    }

    /// Whether it is that of the linear body.
    pub fn is_linear(&self) -> bool {
        self.count == 1
    }

    /// G where the linear contact holds so much, J/Pa.
    pub fn at(&self, energy: f64) -> f64 {
        self.at_depth(energy.max(0.0).sqrt())
    }

    fn at_depth(&self, depth: f64) -> f64 {
        let k = self.knot_before(depth);
        self.knots[k].share + self.slope(k) * (depth - self.knots[k].depth)
    }

    /// The mean of G on the way out of a spring that holds so much, J/Pa: with it that is what is held. The
    /// body is moved by so many times as far besides as the spring is, which stays.
    pub fn mean(&self, energy: f64, remembered: f64) -> f64 {
        if self.is_linear() || energy <= 0.0 {
            return 1.0;
        }
        // 2 times the integral of G((s + r)^2 W) s ds from 0 to 1.
        let own = energy.sqrt();
        let [plain, times_depth] = self.on_the_way(own, remembered);
        2.0 * (times_depth - remembered * own * plain) / energy
    }

    /// How much of what such a spring presses with is kept as what is remembered grows and it goes back: as a share
    /// of the force there.
    pub fn kept(&self, energy: f64, remembered: f64) -> f64 {
        if self.is_linear() || energy <= 0.0 {
            return 0.0;
        }
        let own = energy.sqrt();
        let [plain, _] = self.on_the_way(own, remembered);
        1.0 - plain / (own * self.at_depth((1.0 + remembered) * own))
    }

    /// By how much more steeply than firmly the force grows with the depth, 1 or more.
    pub fn steepness(&self, energy: f64) -> f64 {
        let depth = energy.max(0.0).sqrt();
        let k = self.knot_before(depth);
        (1.0 + depth * self.slope(k) / self.at_depth(depth)).max(1.0)
    }

    /// The same where another fades in, with that one's knots beside those of its own that are nearest to a
    /// press which holds so much, J/Pa.
    #[must_use]
    pub fn beside(&self, other: &Self, energy: f64) -> Self {
        let depth = energy.max(0.0).sqrt();
        let mut all = [0.0; 1 + MOST_KNOTS + KEPT];
        let mut count = 0;
        for knot in &other.knots[1..other.count] {
            all[count] = knot.depth;
            count += 1;
        }
        let middle = self
            .knot_before(depth)
            .min(self.count.saturating_sub(KEPT / 2));
        let first = middle.saturating_sub(KEPT / 2).max(1);
        let own = self.knots[first..self.count].iter().map(|knot| knot.depth);
        for at in std::iter::once(depth).chain(own).take(KEPT) {
            let is_new = (all[..count].iter()).all(|&known| (at - known).abs() > APART * known);
            if is_new && at > 0.0 {
                all[count] = at;
                count += 1;
            }
        }
        let all = &mut all[..count];
        all.sort_unstable_by(f64::total_cmp);
        Self::of(all.iter().map(|&at| (at, self.at_depth(at))))
    }

    /// A tick of `dt` s nearer to another, whose knots it has.
    pub fn fade(&mut self, to: &Self, dt: f64) {
        // A number also where the time between ticks is none or has no end.
        let share = 1.0 / (1.0 + FADING / dt);
        let mut most = 0.0_f64;
        for knot in &mut self.knots[1..self.count] {
            knot.share += (to.at_depth(knot.depth) - knot.share) * share;
            most = most.max((knot.share - 1.0).abs());
        }
        if to.is_linear() && most <= NONE {
            *self = Self::default();
        }
        self.sum_up();
    }

    /// Number of the last knot that is not deeper.
    fn knot_before(&self, depth: f64) -> usize {
        self.knots[1..self.count].partition_point(|knot| knot.depth <= depth)
    }

    /// G over the depth behind a knot; level beyond the last.
    fn slope(&self, k: usize) -> f64 {
        if k + 1 >= self.count {
            return 0.0;
        }
        let (from, to) = (&self.knots[k], &self.knots[k + 1]);
        (to.share - from.share) / (to.depth - from.depth)
    }

    /// Integrals of G, and of G times the depth, on the last part of the way.
    fn on_the_way(&self, own: f64, remembered: f64) -> [f64; 2] {
        let from = remembered * own;
        let to = from + own;
        let (begin, end) = (
            self.sums(self.knot_before(from), from),
            self.sums(self.knot_before(to), to),
        );
        [end[0] - begin[0], end[1] - begin[1]]
    }

    /// Integrals of G, and of G times the depth, to a depth behind a knot.
    fn sums(&self, k: usize, depth: f64) -> [f64; 2] {
        let (knot, slope) = (&self.knots[k], self.slope(k));
        let by = depth - knot.depth;
        let plain = by * (knot.share + 0.5 * slope * by);
        let lever = by * by * (0.5 * knot.share + slope * by / 3.0);
        [
            knot.sums[0] + plain,
            knot.sums[1] + knot.depth * plain + lever,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Firm as 1 + s / 4 + s^2 / 4 at some depths s.
    fn firm() -> Firmness {
        let known = [0.5_f64, 1.0, 1.5, 2.0].map(|s| (s * s, 1.0 + 0.25 * s + 0.25 * s * s));
        Firmness::through(&known).unwrap()
    }

    #[test]
    fn it_is_as_told_at_the_knots_straight_between_them_and_stays_beyond() {
        let firm = firm();
        assert_eq!(firm.at(0.0), 1.0);
        assert_eq!(firm.at(1.0), 1.5);
        assert!((firm.at(1.25 * 1.25) - 0.5 * (firm.at(1.0) + firm.at(2.25))).abs() < 1e-12);
        assert!((firm.at(0.0625) - 0.5 * (1.0 + firm.at(0.25))).abs() < 1e-12);
        assert_eq!((firm.at(4.0), firm.at(1e9)), (2.5, 2.5));
    }

    #[test]
    fn what_is_held_is_the_integral_of_the_firmness() {
        for most in [0.1, 0.5, 3.9, 4.0, 9.0] {
            let steps = 100_000;
            let each = most / f64::from(steps);
            let middle = |k: u32| firm().at((f64::from(k) + 0.5) * each);
            let sum: f64 = (0..steps).map(middle).sum();
            assert!((sum * each / most - firm().mean(most, 0.0)).abs() < 1e-6);
        }
    }

    #[test]
    fn what_a_spring_holds_that_has_gone_back_is_its_work_on_the_way_out() {
        let firm = firm();
        for (energy, remembered) in [(0.3, 0.5), (1.0, 2.0), (3.0, 0.1), (9.0, 0.4), (0.01, 30.0)] {
            let held = |r: f64, of: f64| {
                let steps = 20_000;
                let sum: f64 = (0..steps)
                    .map(|k| (f64::from(k) + 0.5) / f64::from(steps) * of)
                    .map(|s| firm.at(energy * (s + r) * (s + r)) * s)
                    .sum();
                2.0 * energy * sum * of / f64::from(steps)
            };
            let mean = firm.mean(energy, remembered);
            assert!((held(remembered, 1.0) / energy - mean).abs() < 1e-6 * mean);
            // Where the place stays, the spring goes back by what is remembered more.
            let more = 1e-4;
            let gone = held(remembered, 1.0) - held(remembered + more, 1.0 - more);
            let force = firm.at(energy * (1.0 + remembered).powi(2)) * 2.0 * energy;
            let lost = force * more * (1.0 - firm.kept(energy, remembered));
            assert!((gone - lost).abs() < 1e-3 * force * more, "{gone} {lost}");
        }
    }

    #[test]
    fn the_force_grows_as_steeply_as_is_told() {
        // The force goes with the depth s times G, and s with the root of the energy.
        let firm = firm();
        let force = |s: f64| s * firm.at(s * s);
        for s in [0.1, 0.9, 1.9, 3.0] {
            let slope = (force(s + 1e-6) - force(s - 1e-6)) / 2e-6;
            assert!((slope / firm.at(s * s) - firm.steepness(s * s)).abs() < 1e-6);
        }
    }

    #[test]
    fn it_is_bounded_and_told_by_numbers_that_ascend() {
        let wild = Firmness::through(&[(1.0, -5.0), (4.0, 1e9)]).unwrap();
        assert_eq!((wild.at(1.0), wild.at(4.0)), (LEAST, MOST));
        assert!(Firmness::through(&[]).unwrap().is_linear());
        assert_eq!(Firmness::default().at(1.0), 1.0);
        assert_eq!(Firmness::default().mean(1.0, 0.0), 1.0);
        for wrong in [
            [(1.0, 1.0), (1.0, 1.0)],
            [(0.0, 1.0), (1.0, 1.0)],
            [(-1.0, 1.0), (1.0, 1.0)],
            [(1.0, f64::NAN), (2.0, 1.0)],
            [(1.0, 1.0), (f64::INFINITY, 1.0)],
        ] {
            assert!(Firmness::through(&wrong).is_none());
        }
        let many: Vec<_> = (0..=MOST_KNOTS).map(|k| (1.0 + k as f64, 1.0)).collect();
        assert!(Firmness::through(&many).is_none());
    }

    #[test]
    fn between_two_of_them_it_is_never_beyond_both_and_comes_to_the_other() {
        let firm = firm();
        let shallow = Firmness::through(&[(1e-12, 1.001)]).unwrap();
        let mut now = shallow.beside(&firm, 4.0);
        for _ in 0..50 {
            now.fade(&firm, 1e-3);
        }
        assert!(now.at(4.0) > 1.0 + 0.3 * 1.5 && now.at(4.0) < 2.5);
        for _ in 0..2000 {
            now.fade(&firm, 1e-3);
            for energy in [1e-13, 1e-6, 0.1, 4.0] {
                assert!(now.at(energy) > 1.0 - 1e-9 && now.at(energy) <= 2.5);
            }
        }
        for energy in [0.01, 1.0, 2.0, 4.0, 9.0] {
            assert!((now.at(energy) - firm.at(energy)).abs() < 1e-9);
        }
        let mut back = firm.beside(&Firmness::default(), 2.0);
        for _ in 0..2000 {
            assert!(back.at(2.0) >= 1.0 && back.at(2.0) <= firm.at(2.0));
            back.fade(&Firmness::default(), 1e-3);
        }
        assert!(back.is_linear());
    }

    #[test]
    fn where_another_comes_it_is_at_first_what_it_was() {
        let many: Vec<_> = (1..=MOST_KNOTS)
            .map(|k| (0.01 * (k * k) as f64, 1.0 + 0.1 * (k % 3) as f64))
            .collect();
        let many = Firmness::through(&many).unwrap();
        let other = Firmness::through(&[(0.3, 2.0), (3.0, 3.0)]).unwrap();
        for press in [0.02, 1.0, 9.0, 30.0] {
            let beside = many.beside(&other, press);
            for near in [0.95, 1.0, 1.05] {
                assert!((beside.at(near * press) - many.at(near * press)).abs() < 1e-3);
            }
            // As many times as it may come.
            let mut now = beside;
            for _ in 0..5 {
                now = now.beside(&other, press).beside(&many, press);
            }
            assert!((now.at(press) - many.at(press)).abs() < 1e-3);
        }
    }
}
