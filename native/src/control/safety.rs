//! Limits between a computed force and a motor: pure, and on by default.
//!
//! Going to zero is never delayed: permission withdrawn, a fault or a number that is not finite
//! give zero in the same tick, and so goes what points against the force wanted. Growing is limited three times, by ramp, clamp and slew.

use glam::DVec3;

/// Limits of the final force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest force, N; the smaller of the user's and the device's.
    pub max_force: f64,
    /// Fastest growth or turn of the force, N/s.
    pub max_slew: f64,
    /// Time from silence to the full force after start, enabling and every fault, s.
    pub ramp_seconds: f64,
}

/// Names of the limiters, beside a force that one of them shortens.
pub const LIMITERS: [&str; 3] = [RAMP, CLAMP, SLEW];
/// The force is still coming back.
pub const RAMP: &str = "ramp";
/// The body gives more than the largest force.
pub const CLAMP: &str = "clamp";
/// The force grows or turns faster than allowed.
pub const SLEW: &str = "slew";

/// A force that may be sent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limited {
    /// N.
    pub force: DVec3,
    /// Limiter that shortened it, one of [`LIMITERS`], or empty; of several the first in that order.
    pub by: &'static str,
}

/// Limits the force from tick to tick.
#[derive(Debug, Clone, Copy, Default)]
pub struct Safety {
    gain: f64,
    output: DVec3,
}

impl Safety {
    /// Zero now, and a ramp when force is allowed again.
    pub fn silence(&mut self) -> DVec3 {
        *self = Self::default();
        DVec3::ZERO
    }

    /// Whether the ramp is through.
    pub fn is_ramped(&self) -> bool {
        self.gain >= 1.0
    }

    /// The force to send for the force `wanted` and the `brake` beside it (N), `dt` seconds after the
    /// last one. A brake is for the force as far as it is sent: it is added to what the clamp leaves.
    ///
    /// None when one of them or a limit is not finite: the caller reports the fault, the output is
    /// zero and ramps up again. The output is never larger than both together, so no limit can hold a
    /// force that the body no longer gives.
    pub fn limit(
        &mut self,
        wanted: DVec3,
        brake: DVec3,
        limits: &Limits,
        dt: f64,
    ) -> Option<Limited> {
        let numbers_are_sound = wanted.is_finite()
            && brake.is_finite()
            && limits.max_force >= 0.0
            && limits.max_slew >= 0.0
            && limits.ramp_seconds >= 0.0
            && dt >= 0.0
            && dt.is_finite();
        if !numbers_are_sound {
            self.silence();
            return None;
        }
        self.gain = if limits.ramp_seconds > 0.0 {
            (self.gain + dt / limits.ramp_seconds).min(1.0)
        } else {
            1.0
        };
        let clamped = shorten(shorten(wanted, limits.max_force) + brake, limits.max_force);
        let ramped = clamped * self.gain;
        let last = without_opposed(self.output, ramped);
        let change = shorten(ramped - last, limits.max_slew * dt);
        let is_slewed = change != ramped - last;
        // Without slew exactly what is wanted, else what the last force and the change make of it.
        self.output = if is_slewed {
            shorten(last + change, ramped.length())
        } else {
            ramped
        };
        let by = if self.output == wanted + brake {
            ""
        } else if self.gain < 1.0 {
            RAMP
        } else if clamped != wanted + brake {
            CLAMP
        } else {
            SLEW
        };
        Some(Limited {
            force: self.output,
            by,
        })
    }
}

/// What of a force does not point against what is wanted now: that part goes at once, like all of a
/// force that is no longer wanted.
fn without_opposed(force: DVec3, wanted: DVec3) -> DVec3 {
    let way = wanted.normalize_or_zero();
    force - way * force.dot(way).min(0.0)
}

/// The vector, cut to `length` if it is longer, with its direction.
fn shorten(v: DVec3, length: f64) -> DVec3 {
    let own = v.length();
    if own <= length {
        v
    } else if own.is_finite() {
        v * (length / own)
    } else {
        // The square overflowed: scale down first.
        let small = v / v.abs().max_element();
        small * (length / small.length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OPEN: Limits = Limits {
        max_force: 3.0,
        max_slew: f64::MAX,
        ramp_seconds: 0.0,
    };
    const DT: f64 = 1e-3;

    #[test]
    fn clamp_keeps_the_direction() {
        let force = Safety::default()
            .limit(DVec3::new(30.0, 40.0, 0.0), DVec3::ZERO, &OPEN, DT)
            .unwrap()
            .force;
        assert!(force.distance(DVec3::new(1.8, 2.4, 0.0)) < 1e-12);
        let huge = Safety::default()
            .limit(DVec3::splat(1e300), DVec3::ZERO, &OPEN, DT)
            .unwrap()
            .force;
        assert!((huge.length() - 3.0).abs() < 1e-12);
    }

    #[test]
    fn force_ramps_from_nothing() {
        let limits = Limits {
            ramp_seconds: 0.1,
            ..OPEN
        };
        let mut safety = Safety::default();
        let mut last = 0.0;
        for tick in 1..=100 {
            let force = safety
                .limit(DVec3::X, DVec3::ZERO, &limits, DT)
                .unwrap()
                .force
                .x;
            assert!((force - f64::from(tick) * 0.01).abs() < 1e-9);
            assert!(force > last);
            last = force;
        }
        let whole = safety.limit(DVec3::X, DVec3::ZERO, &limits, DT).unwrap();
        assert_eq!((whole.force, whole.by), (DVec3::X, ""));
    }

    #[test]
    fn silence_is_immediate_and_ramps_again() {
        let limits = Limits {
            ramp_seconds: 0.1,
            ..OPEN
        };
        let mut safety = Safety::default();
        for _ in 0..200 {
            safety.limit(DVec3::X, DVec3::ZERO, &limits, DT);
        }
        assert_eq!(safety.silence(), DVec3::ZERO);
        assert!(
            safety
                .limit(DVec3::X, DVec3::ZERO, &limits, DT)
                .unwrap()
                .force
                .x
                < 0.011
        );
    }

    #[test]
    fn slew_limits_growth_and_turning_but_never_holds_a_force() {
        let limits = Limits {
            max_slew: 100.0,
            ..OPEN
        };
        let mut safety = Safety::default();
        assert!(
            (safety
                .limit(DVec3::X, DVec3::ZERO, &limits, DT)
                .unwrap()
                .force
                .x
                - 0.1)
                .abs()
                < 1e-12
        );
        for _ in 0..20 {
            safety.limit(DVec3::X, DVec3::ZERO, &limits, DT);
        }
        let turned = safety
            .limit(DVec3::Y, DVec3::ZERO, &limits, DT)
            .unwrap()
            .force;
        assert!(turned.distance(DVec3::X) <= 0.1 + 1e-12);
        let gone = safety.limit(DVec3::ZERO, DVec3::ZERO, &limits, DT).unwrap();
        assert_eq!((gone.force, gone.by), (DVec3::ZERO, ""));
    }

    /// Along whatever way the force wanted goes from one tick to the next, nothing that is sent points
    /// against it, and what it grows and turns by stays within the slew.
    #[test]
    fn a_force_that_turns_round_never_points_the_old_way() {
        let limits = Limits {
            max_slew: 1000.0,
            ..OPEN
        };
        for degrees in 0..=180 {
            let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
            let turned = DVec3::new(cosine, sine, 0.0) * 3.0;
            let mut safety = Safety::default();
            for _ in 0..10 {
                safety.limit(DVec3::X * 3.0, DVec3::ZERO, &limits, DT);
            }
            let mut last = DVec3::X * 3.0;
            for tick in 0..10 {
                let sent = safety.limit(turned, DVec3::ZERO, &limits, DT);
                let force = sent.expect("sound numbers").force;
                let along = force.dot(turned);
                assert!(along >= -1e-12, "{degrees} degrees, tick {tick}: {force}");
                let dropped = (-last.dot(turned) / 3.0).max(0.0);
                assert!(force.distance(last) <= 1.0 + dropped + 1e-9);
                last = force;
            }
            assert!(last.distance(turned) < 1e-9, "{degrees}: {last}");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_give_no_force() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut safety = Safety::default();
            safety.limit(DVec3::X, DVec3::ZERO, &OPEN, DT);
            assert_eq!(
                safety.limit(DVec3::new(0.0, bad, 0.0), DVec3::ZERO, &OPEN, DT),
                None
            );
            let nan_limit = Limits {
                max_force: f64::NAN,
                ..OPEN
            };
            assert_eq!(safety.limit(DVec3::X, DVec3::ZERO, &nan_limit, DT), None);
        }
    }
}
