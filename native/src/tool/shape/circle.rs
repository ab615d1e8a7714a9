//! Where on a circle of directions the nearest of some core points is farthest.

use glam::DVec2;

/// Directions on the circle at the limit that are looked at first.
const TURNS: usize = 24;
/// Core points that can be nearest at once on that circle, of those nearest where it was looked at.
const MOST_AT_ONCE: usize = 8;

/// How far a point is from a core point along each direction of the circle: level + slope . (c, s).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sinusoid {
    pub level: f64,
    pub slope: DVec2,
}

impl Sinusoid {
    #[inline]
    fn at(&self, turn: DVec2) -> f64 {
        self.level + self.slope.dot(turn)
    }
}

/// Where a sinusoid is greatest.
#[inline]
pub(super) fn peak(sinusoid: &Sinusoid) -> DVec2 {
    sinusoid.slope.try_normalize().unwrap_or(DVec2::X)
}

#[inline]
fn least(sinusoids: &[Sinusoid], turn: DVec2) -> f64 {
    let at = |least: f64, sinusoid: &Sinusoid| least.min(sinusoid.at(turn));
    sinusoids.iter().fold(f64::INFINITY, at)
}

/// The least, if it is above a bound: else it ends at the first eight of which one is not.
#[inline]
fn least_above(sinusoids: &[Sinusoid], turn: DVec2, bound: f64) -> Option<f64> {
    let mut value = f64::INFINITY;
    for eight in sinusoids.chunks(8) {
        value = value.min(least(eight, turn));
        if value <= bound {
            return None;
        }
    }
    (value > bound).then_some(value)
}

/// Where the least of some sinusoids is greatest: at the peak of one, or where two cross.
pub(super) fn highest(sinusoids: &[Sinusoid]) -> DVec2 {
    let mut few = [0; MOST_AT_ONCE];
    let few = if sinusoids.len() <= MOST_AT_ONCE {
        (few.iter_mut().enumerate()).for_each(|(k, place)| *place = k);
        &few[..sinusoids.len()]
    } else {
        nearest_few(sinusoids, &mut few);
        &few
    };
    let mut lowest = [0; MOST_AT_ONCE];
    let lowest = somewhere_lowest(sinusoids, few, &mut lowest);
    let mut nearest = [Sinusoid::default(); MOST_AT_ONCE];
    let compared = if few.len() == sinusoids.len() {
        for (nearest, &i) in nearest.iter_mut().zip(lowest) {
            *nearest = sinusoids[i];
        }
        &nearest[..lowest.len()]
    } else {
        sinusoids
    };
    let mut best = (f64::NEG_INFINITY, DVec2::X);
    let mut offer = |turn: DVec2| {
        // Most are below the best along one of the nearest already.
        let some = lowest
            .iter()
            .fold(f64::INFINITY, |some, &i| some.min(sinusoids[i].at(turn)));
        if some > best.0 {
            let value = least(compared, turn);
            if value > best.0 {
                best = (value, turn);
            }
        }
    };
    for (place, &i) in lowest.iter().enumerate() {
        offer(peak(&sinusoids[i]));
        for &j in &lowest[..place] {
            let between = sinusoids[i].slope - sinusoids[j].slope;
            let length = between.length();
            if length > 0.0 {
                let level = (sinusoids[j].level - sinusoids[i].level) / length;
                let level = level.clamp(-1.0, 1.0);
                let (along, apart) = (between / length, (1.0 - level * level).sqrt());
                offer(along * level + along.perp() * apart);
                offer(along * level - along.perp() * apart);
            }
        }
    }
    best.1
}

/// Of some sinusoids those with none of the others below them all round: of a plate's eight corners
/// the four of its face.
fn somewhere_lowest<'a>(
    sinusoids: &[Sinusoid],
    few: &[usize],
    lowest: &'a mut [usize; MOST_AT_ONCE],
) -> &'a [usize] {
    let mut count = 0;
    for &i in few {
        let is_above = |&j: &usize| {
            let height = sinusoids[i].level - sinusoids[j].level;
            let swing = sinusoids[i].slope.distance_squared(sinusoids[j].slope);
            let is_alike = height == 0.0 && swing == 0.0;
            height >= 0.0 && height * height >= swing && (j < i || (j != i && !is_alike))
        };
        if !few.iter().any(is_above) {
            lowest[count] = i;
            count += 1;
        }
    }
    &lowest[..count]
}

/// The core points that are nearest where the least of all is greatest, of some directions.
fn nearest_few(sinusoids: &[Sinusoid], few: &mut [usize; MOST_AT_ONCE]) {
    let mut best = (f64::NEG_INFINITY, DVec2::X);
    // The first turn of the circle, over and over: no sine is asked for in the tick.
    let (sine, cosine) = (std::f64::consts::TAU / TURNS as f64).sin_cos();
    let (step, mut turn) = (DVec2::new(cosine, sine), DVec2::X);
    for _ in 0..TURNS {
        if let Some(value) = least_above(sinusoids, turn, best.0) {
            best = (value, turn);
        }
        turn = step.rotate(turn);
    }
    let mut count = 0;
    for (k, sinusoid) in sinusoids.iter().enumerate() {
        let value = sinusoid.at(best.1);
        let before = |other: &usize| sinusoids[*other].at(best.1) <= value;
        let place = few[..count]
            .iter()
            .take_while(|other| before(other))
            .count();
        if place < MOST_AT_ONCE {
            count = (count + 1).min(MOST_AT_ONCE);
            few.copy_within(place..count - 1, place + 1);
            few[place] = k;
        }
    }
}
