//! A device and a hand that move on one axis.
//!
//! Positive is into the body. Between events all forces but spring, damper and friction are
//! constant, and the motion is summed to the last digit by its Taylor series; reversals under
//! Coulomb friction are found and end in true sticking.

/// The moving part of a device and its electronics. SI units; steps of zero are none.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "python", derive(pyo3::FromPyObject))]
pub struct Plant {
    /// Moving mass, kg.
    pub mass: f64,
    /// Viscous friction, N s/m.
    pub damping: f64,
    /// Coulomb friction, N.
    pub coulomb: f64,
    /// Encoder step, m.
    pub encoder_step: f64,
    /// Step of the motor's force, N.
    pub force_step: f64,
    /// From the encoder's reading to the motor's obeying, without the holding of a tick, s.
    pub delay: f64,
    /// Random part of the delay, s; a command that comes after a newer one is not obeyed.
    pub jitter: f64,
}

/// A passive hand: a spring and a damper to a place that rests, and a constant push.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "python", derive(pyo3::FromPyObject))]
pub struct Hand {
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
    /// N, into the body.
    pub push: f64,
    /// Rest position of the spring's other end, m into the body.
    pub target: f64,
}

const TERMS: usize = 9;
const REVERSALS: usize = 4;

/// The moving part from moment to moment, with its books of energy.
pub(super) struct Motion {
    plant: Plant,
    grip: Hand,
    pub(super) x: f64,
    pub(super) v: f64,
    pub(super) motor: f64,
    pub(super) hand: f64,
    pub(super) viscous: f64,
    pub(super) rubbed: f64,
}

impl Motion {
    pub(super) fn new(plant: &Plant, grip: &Hand, (start, speed): (f64, f64)) -> Self {
        Self {
            plant: *plant,
            grip: *grip,
            x: start,
            v: speed,
            motor: 0.0,
            hand: 0.0,
            viscous: 0.0,
            rubbed: 0.0,
        }
    }

    /// Moves for `seconds` under a constant motor force.
    pub(super) fn advance(&mut self, force: f64, seconds: f64) {
        let grip = self.grip;
        let load = force + grip.push + grip.stiffness * grip.target;
        let mut left = seconds;
        for _ in 0..REVERSALS {
            let pull = load - grip.stiffness * self.x;
            if self.v == 0.0 && pull.abs() <= self.plant.coulomb {
                return;
            }
            let way = if self.v == 0.0 { pull } else { self.v }.signum();
            let series = self.series(load - way * self.plant.coulomb);
            let (end, reversed) = match reversal(&series, left, way) {
                Some(time) => (time, true),
                None => (left, false),
            };
            self.book(&series, end, force);
            self.x = value(&series, end);
            self.v = if reversed { 0.0 } else { slope(&series, end) };
            left -= end;
            if !reversed || left <= 0.0 {
                return;
            }
        }
        // Reversing again and again within microseconds: it stays until the next step.
    }

    /// Coefficients of the position's Taylor series under a constant load.
    fn series(&self, load: f64) -> [f64; TERMS] {
        let (k, c) = (self.grip.stiffness, self.plant.damping + self.grip.damping);
        let mut a = [0.0; TERMS];
        (a[0], a[1]) = (self.x, self.v);
        a[2] = (load - k * self.x - c * self.v) / (2.0 * self.plant.mass);
        for n in 2..TERMS - 1 {
            let order = n as f64;
            a[n + 1] =
                -(c * order * a[n] + k * a[n - 1]) / (self.plant.mass * order * (order + 1.0));
        }
        a
    }

    fn book(&mut self, series: &[f64; TERMS], seconds: f64, force: f64) {
        let (begin, end) = (self.x, value(series, seconds));
        let way = end - begin;
        let squared = seconds
            * GAUSS
                .iter()
                .map(|&(place, weight)| weight * slope(series, place * seconds).powi(2))
                .sum::<f64>();
        let grip = self.grip;
        self.motor += force * way;
        self.hand += (grip.push + grip.stiffness * (grip.target - 0.5 * (begin + end))) * way
            - grip.damping * squared;
        self.viscous += self.plant.damping * squared;
        self.rubbed += self.plant.coulomb * way.abs();
    }
}

/// Gauss and Legendre's places and weights on [0, 1].
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

fn value(series: &[f64; TERMS], t: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, a| sum * t + a)
}

fn slope(series: &[f64; TERMS], t: f64) -> f64 {
    (1..TERMS)
        .rev()
        .fold(0.0, |sum, n| sum * t + n as f64 * series[n])
}

/// Time of the velocity's change of sign within `seconds`, by bisection.
fn reversal(series: &[f64; TERMS], seconds: f64, way: f64) -> Option<f64> {
    if slope(series, seconds) * way >= 0.0 {
        return None;
    }
    let (mut before, mut after) = (0.0, seconds);
    for _ in 0..40 {
        let middle = 0.5 * (before + after);
        if slope(series, middle) * way > 0.0 {
            before = middle;
        } else {
            after = middle;
        }
    }
    Some(after)
}
