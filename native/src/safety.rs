//! What stands between a computed force and a motor: pure, and on by default.
//!
//! Going to zero is never delayed: permission withdrawn, a fault or a number that is not finite
//! give zero in the same tick. Growing is limited three times, by ramp, clamp and slew.

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
    /// What shortened it, one of [`LIMITERS`], or empty; of several the first in that order.
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

    /// The force to send for the force `wanted` (N), `dt` seconds after the last one.
    ///
    /// None when `wanted` or a limit is not finite: the caller reports the fault, the output is
    /// zero and ramps up again. The output is never larger than `wanted`, so no limit can hold a
    /// force that the body no longer gives.
    pub fn limit(&mut self, wanted: DVec3, limits: &Limits, dt: f64) -> Option<Limited> {
        let numbers_are_sound = wanted.is_finite()
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
        let clamped = shorten(wanted, limits.max_force);
        let ramped = clamped * self.gain;
        let change = shorten(ramped - self.output, limits.max_slew * dt);
        let is_slewed = change != ramped - self.output;
        // Without slew exactly what is wanted, else what the last force and the change make of it.
        self.output = if is_slewed {
            shorten(self.output + change, ramped.length())
        } else {
            ramped
        };
        let by = if self.output == wanted {
            ""
        } else if self.gain < 1.0 {
            RAMP
        } else if clamped != wanted {
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

/// A device's clock is compared with the host's over this time, s.
const CLOCK_SECONDS: f64 = 0.25;
/// A device's clock that goes faster or slower than the host's by more than this factor, twice in a
/// row, is wrong. Once may be what a line had stored.
const CLOCK_FACTOR: f64 = 2.0;
/// After silence for so long, or a host that was held up, clocks are compared afresh, s.
const GAP_SECONDS: f64 = 0.02;
/// What comes together may have been this long on its way, s: more time than that and what the host
/// saw go by, the device cannot have taken.
const DELAY_SECONDS: f64 = 0.05;

/// Where a device was, by both clocks.
#[derive(Debug, Clone, Copy)]
struct Seen {
    position: DVec3,
    device_us: u32,
    now: f64,
    /// When something had come before that; what comes together was measured since then.
    before: f64,
}

/// Measures a device's speed from its own clock, as long as that can be believed.
///
/// The device's clock knows nothing of delays on the line; but one that stands still, runs backwards
/// or too fast would hide a speed that is too large. Then the host's clock serves: a jump on the line
/// may look faster by it than it was, never slower.
#[derive(Debug, Clone, Copy, Default)]
pub struct Speedometer {
    last: Option<Seen>,
    compared: Option<Seen>,
    /// Comparisons in a row that were out of bounds.
    strikes: u32,
}

impl Speedometer {
    /// Forgets the last position, for after a gap; not what was found of the clock.
    pub fn reset(&mut self) {
        self.last = None;
        self.compared = None;
    }

    /// Speed (m/s) at `position` (m), reached at `device_us` by the device's clock and `now`
    /// seconds by the host's.
    pub fn speed(&mut self, position: DVec3, device_us: u32, now: f64) -> f64 {
        let here = Seen {
            position,
            device_us,
            now,
            before: match self.last {
                Some(last) if last.now == now => last.before,
                Some(last) => last.now,
                None => now,
            },
        };
        self.compare_clocks(&here);
        let Some(last) = self.last.replace(here) else {
            return 0.0;
        };
        let way = position.distance(last.position);
        if way == 0.0 {
            return 0.0;
        }
        let (device, host) = elapsed(&last, &here);
        let can_be = device > 0.0 && device <= now - last.before + DELAY_SECONDS;
        let seconds = if can_be && self.strikes < 2 {
            device
        } else {
            host
        };
        way / seconds.max(1e-6)
    }

    fn compare_clocks(&mut self, here: &Seen) {
        if self
            .last
            .is_some_and(|last| here.now - last.now > GAP_SECONDS)
        {
            self.compared = None;
        }
        let since = *self.compared.get_or_insert(*here);
        let (device, host) = elapsed(&since, here);
        if host >= CLOCK_SECONDS {
            let bounds = host / CLOCK_FACTOR..=host * CLOCK_FACTOR;
            self.strikes = if bounds.contains(&device) {
                0
            } else {
                self.strikes.saturating_add(1)
            };
            self.compared = Some(*here);
        }
    }
}

/// Time between two places by the device's clock, which wraps, and by the host's, s.
fn elapsed(from: &Seen, to: &Seen) -> (f64, f64) {
    let device = f64::from(to.device_us.wrapping_sub(from.device_us)) * 1e-6;
    (device, to.now - from.now)
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
            .limit(DVec3::new(30.0, 40.0, 0.0), &OPEN, DT)
            .unwrap()
            .force;
        assert!(force.distance(DVec3::new(1.8, 2.4, 0.0)) < 1e-12);
        let huge = Safety::default()
            .limit(DVec3::splat(1e300), &OPEN, DT)
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
            let force = safety.limit(DVec3::X, &limits, DT).unwrap().force.x;
            assert!((force - f64::from(tick) * 0.01).abs() < 1e-9);
            assert!(force > last);
            last = force;
        }
        let whole = safety.limit(DVec3::X, &limits, DT).unwrap();
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
            safety.limit(DVec3::X, &limits, DT);
        }
        assert_eq!(safety.silence(), DVec3::ZERO);
        assert!(safety.limit(DVec3::X, &limits, DT).unwrap().force.x < 0.011);
    }

    #[test]
    fn slew_limits_growth_and_turning_but_never_holds_a_force() {
        let limits = Limits {
            max_slew: 100.0,
            ..OPEN
        };
        let mut safety = Safety::default();
        assert!((safety.limit(DVec3::X, &limits, DT).unwrap().force.x - 0.1).abs() < 1e-12);
        for _ in 0..20 {
            safety.limit(DVec3::X, &limits, DT);
        }
        let turned = safety.limit(DVec3::Y, &limits, DT).unwrap().force;
        assert!(turned.distance(DVec3::X) <= 0.1 + 1e-12);
        let gone = safety.limit(DVec3::ZERO, &limits, DT).unwrap();
        assert_eq!((gone.force, gone.by), (DVec3::ZERO, ""));
    }

    #[test]
    fn numbers_that_are_not_finite_give_no_force() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut safety = Safety::default();
            safety.limit(DVec3::X, &OPEN, DT);
            assert_eq!(safety.limit(DVec3::new(0.0, bad, 0.0), &OPEN, DT), None);
            let nan_limit = Limits {
                max_force: f64::NAN,
                ..OPEN
            };
            assert_eq!(safety.limit(DVec3::X, &nan_limit, DT), None);
        }
    }

    #[test]
    fn speed_uses_the_devices_clock_and_survives_its_wrap() {
        let mut meter = Speedometer::default();
        assert_eq!(meter.speed(DVec3::ZERO, u32::MAX - 499, 0.0), 0.0);
        let speed = meter.speed(DVec3::X * 1e-3, 500, 0.005);
        assert!((speed - 1.0).abs() < 1e-9);
        let by_host = meter.speed(DVec3::X * 3e-3, 500, 0.006);
        assert!((by_host - 2.0).abs() < 1e-6);
    }

    /// Speeds of a device that goes at 5 m/s, by a clock of its own.
    fn measured(clock: impl Fn(u32) -> u32) -> Vec<f64> {
        let mut meter = Speedometer::default();
        (0..2000)
            .map(|ms| {
                let position = DVec3::X * 5e-3 * f64::from(ms);
                meter.speed(position, clock(ms), f64::from(ms) * 1e-3)
            })
            .collect()
    }

    #[test]
    fn a_device_with_a_wrong_clock_is_not_taken_for_a_slow_one() {
        let right = |ms: u32| 4_294_000_000_u32.wrapping_add(1000 * ms);
        assert!(measured(right)[1..].iter().all(|v| (v - 5.0).abs() < 1e-6));
        let stands_still = measured(|_| 77);
        let backwards = measured(|ms| 4_000_000_u32.wrapping_sub(1000 * ms));
        for speeds in [stands_still, backwards] {
            assert!(speeds[1..].iter().all(|v| (v - 5.0).abs() < 1e-6));
        }
        // A clock that only goes too fast is found out after half a second.
        let too_fast = measured(|ms| 30_000 * ms);
        assert!(too_fast[..500].iter().all(|v| *v < 1.0));
        assert!(too_fast[502..].iter().all(|v| (v - 5.0).abs() < 1e-6));
    }

    #[test]
    fn what_a_line_has_stored_while_the_host_was_stopped_is_no_speed() {
        let mut meter = Speedometer::default();
        let mut worst = 0.0_f64;
        for ms in 0..3000_u32 {
            // At 0.5 m/s; the host sees nothing from 1 s to 2 s, then 900 at once; 100 were lost.
            let now = match ms {
                1000..1900 => 2.0 + f64::from(ms - 1000) / 160.0 * 1e-3,
                1900..2000 => continue,
                _ => f64::from(ms) * 1e-3 + if ms < 2010 && ms > 1999 { 0.006 } else { 0.0 },
            };
            let speed = meter.speed(DVec3::X * 5e-4 * f64::from(ms), 1000 * ms, now);
            if ms != 2000 {
                worst = worst.max(speed);
            }
        }
        assert!(worst < 0.5 + 1e-6, "{worst}");
    }

    #[test]
    fn a_machine_that_holds_up_both_ends_makes_no_speed() {
        let mut meter = Speedometer::default();
        for ms in 0..100_u32 {
            meter.speed(
                DVec3::X * 1e-4 * f64::from(ms),
                1000 * ms,
                f64::from(ms) * 1e-3,
            );
        }
        // Both stand still for 80 ms: one STATE of before and one of after come together.
        let before = meter.speed(DVec3::X * 1e-2, 100_000, 0.18);
        let after = meter.speed(DVec3::X * 1.8e-2, 180_000, 0.18);
        assert!(before.max(after) < 0.1 + 1e-9, "{before} {after}");
    }

    #[test]
    fn bursts_of_an_ordinary_device_are_no_speed() {
        let mut meter = Speedometer::default();
        for ms in 0..2000_u32 {
            // A line that hands over what it has every 16 ms.
            let now = f64::from(ms.div_ceil(16) * 16) * 1e-3;
            let speed = meter.speed(DVec3::X * 1e-3 * f64::from(ms), 1000 * ms, now);
            assert!(speed < 1.0 + 1e-6, "{ms}: {speed}");
        }
    }
}
