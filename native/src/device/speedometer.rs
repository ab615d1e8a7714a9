//! Speed of a device, by its own clock as far as the host's allows.

use glam::DVec3;

use crate::device::course::{Course, Elapsed, Step};
use crate::device::transit::Transit;

/// A device's clock is compared with the host's over this time, s.
const CLOCK_SECONDS: f64 = 0.25;
/// A device's clock that goes faster or slower than the host's by more than this factor, twice in a
/// row, is wrong. Once may be what a line had stored.
const CLOCK_FACTOR: f64 = 2.0;
/// After silence for so long, or a host that was held up, clocks are compared afresh, s.
const GAP_SECONDS: f64 = 0.02;
/// Longest delay of messages of which the shortest is not known yet, s.
const DELAY_SECONDS: f64 = 0.05;
/// Longest time between two messages of one device, s. More is a clock that ran backwards.
const BACKWARDS_SECONDS: f64 = 2000.0;

/// Time between messages that came together where the clocks do not tell, s: a jump is found, while
/// the small steps of an ordinary hand are none.
const TOGETHER_SECONDS: f64 = 5e-4;

/// Position of a device, with its time by both clocks.
#[derive(Debug, Clone, Copy)]
struct Seen {
    position: DVec3,
    device_us: u32,
    now: f64,
    /// Position and time (s) of the first message after a pause: what comes together was
    /// measured since then.
    before: (DVec3, f64),
}

/// Measures a device's speed: a step took as long as its own clock says, and no longer than the host's
/// allows.
///
/// The device's clock knows nothing of delays on the line; but one that stands still, runs backwards,
/// leaps or runs too fast would hide a speed that is too large. So none is believed that says that a
/// message was made after it came, and one that tells nothing gives way to the host's: a jump on the
/// line may look faster by it than it was, never slower.
#[derive(Debug, Clone, Copy, Default)]
pub struct Speedometer {
    last: Option<Seen>,
    /// Time of the last message, s.
    heard: f64,
    course: Course,
    transit: Transit,
    compared: Option<Seen>,
    /// Comparisons in a row that were out of bounds.
    strikes: u32,
}

impl Speedometer {
    /// Forgets the last position, for another session; not what was found of the clock.
    pub fn reset(&mut self) {
        self.interrupt();
        self.course.reset();
    }

    /// The device is out of sight.
    pub fn interrupt(&mut self) {
        self.last = None;
        self.compared = None;
        self.transit = Transit::default();
        self.course.interrupt();
    }

    /// The step to `position` (m), reached at `device_us` by the device's clock and `now` seconds by
    /// the host's.
    pub fn step(&mut self, position: DVec3, device_us: u32, now: f64) -> Step {
        let here = Seen {
            position,
            device_us,
            now,
            before: match self.last {
                Some(last) if last.now == now => last.before,
                Some(last) => (last.position, last.now),
                None => (position, now),
            },
        };
        self.compare_clocks(&here);
        let silence = now - std::mem::replace(&mut self.heard, now);
        let Some(last) = self.last.replace(here) else {
            self.transit.goes_on(now, 0.0);
            return self.course.resume(position, silence);
        };
        let (device, host) = elapsed(&last, &here);
        let tells = device > 0.0 && device < BACKWARDS_SECONDS && self.strikes < 2;
        let way = position.distance(last.position);
        let (seconds, measured) = if tells {
            let since = now - last.before.1;
            let allowed = self.transit.allows(now).unwrap_or(since + DELAY_SECONDS);
            let seconds = device.min(allowed.max(TOGETHER_SECONDS));
            (seconds, way / seconds)
        } else {
            (host.max(TOGETHER_SECONDS), by_host(&here, &last))
        };
        self.transit.goes_on(now, seconds);
        self.course.step(position, Elapsed::of(seconds), measured)
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

/// Speed by the host's clock, m/s. Of what came together the way since the last time counts, and each
/// step for itself.
fn by_host(here: &Seen, last: &Seen) -> f64 {
    let (from, since) = here.before;
    let seconds = here.now - since;
    let since_then = if seconds > 0.0 {
        here.position.distance(from) / seconds
    } else {
        0.0
    };
    let step = here.position.distance(last.position) / TOGETHER_SECONDS;
    if here.now > last.now {
        since_then
    } else {
        since_then.max(step)
    }
}

/// Whether a device that was out of sight for `host_seconds` has begun its clock anew meanwhile, at
/// `to_us` instead of going on from `from_us`: then it was reset, and its encoders may have been too.
pub fn has_begun_anew(from_us: u32, to_us: u32, host_seconds: f64) -> bool {
    let device = f64::from(to_us.wrapping_sub(from_us)) * 1e-6;
    device > host_seconds * CLOCK_FACTOR + DELAY_SECONDS
        || device < host_seconds / CLOCK_FACTOR - DELAY_SECONDS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speed(meter: &mut Speedometer, position: DVec3, device_us: u32, now: f64) -> f64 {
        meter.step(position, device_us, now).speed
    }

    #[test]
    fn a_clock_that_does_not_tell_moments_apart_is_no_speed() {
        // 1 kHz at 50 mm/s; which STATE come together is chance; the clock stands or counts in ms.
        for clock in [|_: u32| 0, |us: u32| us / 1000 * 1000] {
            for together in [2, 3, 16] {
                let mut meter = Speedometer::default();
                for state in 0..2000_u32 {
                    let now = f64::from(state.div_ceil(together) * together) * 1e-3;
                    let jitter = if state % 7 == 0 { 999 } else { 0 };
                    let us = clock(1000 * state + jitter);
                    let found = speed(&mut meter, DVec3::X * 5e-5 * f64::from(state), us, now);
                    assert!(found < 0.2, "{together} {state}: {found}");
                }
                // A jump of 2 mm is one, wherever it comes.
                let there = DVec3::X * (5e-5 * 1999.0 + 2e-3);
                let now = f64::from(1999_u32.div_ceil(together) * together) * 1e-3;
                assert!(speed(&mut meter, there, clock(1_999_000), now) > 2.0);
            }
        }
    }

    #[test]
    fn a_clock_that_begins_anew_is_told_from_one_that_goes_on() {
        assert!(!has_begun_anew(5_000_000, 5_021_000, 0.021));
        assert!(!has_begun_anew(u32::MAX - 99_999, 900_000, 1.0));
        assert!(!has_begun_anew(5_000_000, 6_100_000, 1.0));
        assert!(has_begun_anew(5_000_000, 20_000, 0.3));
        assert!(has_begun_anew(500_000, 700_000, 2.0));
    }

    #[test]
    fn speed_uses_the_devices_clock_and_survives_its_wrap() {
        let mut meter = Speedometer::default();
        assert_eq!(speed(&mut meter, DVec3::ZERO, u32::MAX - 499, 0.0), 0.0);
        let found = speed(&mut meter, DVec3::X * 1e-3, 500, 0.005);
        assert!((found - 1.0).abs() < 1e-9);
        let by_host = speed(&mut meter, DVec3::X * 3e-3, 500, 0.006);
        assert!((by_host - 2.0).abs() < 1e-6);
    }

    /// Speeds of a device that goes at 5 m/s, by a clock of its own.
    fn measured(clock: impl Fn(u32) -> u32) -> Vec<f64> {
        let mut meter = Speedometer::default();
        (0..2000)
            .map(|ms| {
                let position = DVec3::X * 5e-3 * f64::from(ms);
                speed(&mut meter, position, clock(ms), f64::from(ms) * 1e-3)
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
        // The host's clock allows no more than went by on it.
        let too_fast = measured(|ms| 30_000 * ms);
        assert!(too_fast[1..].iter().all(|v| *v > 5.0 - 1e-6));
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
            let found = speed(&mut meter, DVec3::X * 5e-4 * f64::from(ms), 1000 * ms, now);
            if ms != 2000 {
                worst = worst.max(found);
            }
        }
        assert!(worst < 0.5 + 1e-6, "{worst}");
    }

    #[test]
    fn a_machine_that_holds_up_both_ends_makes_no_speed() {
        let mut meter = Speedometer::default();
        for ms in 0..100_u32 {
            speed(
                &mut meter,
                DVec3::X * 1e-4 * f64::from(ms),
                1000 * ms,
                f64::from(ms) * 1e-3,
            );
        }
        // Both stand still for 80 ms: one STATE of before and one of after come together.
        let before = speed(&mut meter, DVec3::X * 1e-2, 100_000, 0.18);
        let after = speed(&mut meter, DVec3::X * 1.8e-2, 180_000, 0.18);
        assert!(before.max(after) < 0.1 + 1e-9, "{before} {after}");
    }

    #[test]
    fn bursts_of_an_ordinary_device_are_no_speed() {
        let mut meter = Speedometer::default();
        for ms in 0..2000_u32 {
            // A line that hands over what it has every 16 ms.
            let now = f64::from(ms.div_ceil(16) * 16) * 1e-3;
            let found = speed(&mut meter, DVec3::X * 1e-3 * f64::from(ms), 1000 * ms, now);
            assert!(found < 1.0 + 1e-6, "{ms}: {found}");
        }
    }
}
