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
        let ascend = (known.windows(2)).all(|two| two[0].0.sqrt() < two[1].0.sqrt());
        let are_finite = (known.iter())
            .all(|&(energy, share)| energy > 0.0 && energy.is_normal() && share.is_finite());
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
mod tests;
