//! The course of a device: where its last steps lead, and how far off it is found.
//!
//! What no clock tells is told here: a hand cannot change its course at once, an encoder that loses its
//! place can.

use glam::DVec3;

/// Farther off its course than this, at once or in parts, a device has not gone: it seems to have, m.
const STRAY: f64 = 4e-3;
/// The course is that of the last steps within about this time, s.
const COURSE_SECONDS: f64 = 2e-3;
/// Longest time for which a course is held to, unless a single step takes longer, s.
const LONGEST_SECONDS: f64 = 3.0 * COURSE_SECONDS;
/// So long a course is held to by a device that is out of sight: what a hand may go on until it turns, s.
const UNSEEN_SECONDS: f64 = 0.1;
/// The first step of all tells a course of this speed at most, m/s.
const FIRST_SPEED: f64 = 1.0;
/// What is off the course was gone within this time at most, s: [`STRAY`] is then as fast as a device
/// may be.
const STRAY_SECONDS: f64 = 2e-3;

/// One step of a device, judged.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Step {
    /// m/s.
    pub speed: f64,
    /// So far off its course that the device, or its encoder, is elsewhere: no way leads here.
    pub has_strayed: bool,
}

impl Step {
    /// Whatever is worse.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            speed: self.speed.max(other.speed),
            has_strayed: self.has_strayed || other.has_strayed,
        }
    }
}

/// A place on the way, with the course that was held there.
#[derive(Debug, Clone, Copy)]
struct Mark {
    place: DVec3,
    velocity: DVec3,
    /// Time since then, s.
    age: f64,
}

impl Mark {
    /// How far `position` lies off the way that leads on from here, m. Less than the whole of it is on
    /// it too.
    fn off(&self, position: DVec3) -> f64 {
        let (way, ahead) = (position - self.place, self.velocity * self.age);
        let part = (way.dot(ahead) / ahead.length_squared()).clamp(0.0, 1.0);
        if part.is_finite() {
            way.distance(ahead * part)
        } else {
            way.length()
        }
    }
}

/// Where a device is and whither it goes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Course {
    place: Option<DVec3>,
    velocity: DVec3,
    /// One to two times [`COURSE_SECONDS`] ago, or a little more, and up to once: a jump in parts is
    /// one, too.
    marks: Option<[Mark; 2]>,
}

impl Course {
    /// Forgets everything: wherever the device is then, it was set down there.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// The device is out of sight: it may have gone on as it went, and have stopped on the way.
    pub fn interrupt(&mut self) {
        self.marks = None;
    }

    /// First place after `seconds` out of sight: no speed, and strayed if it is far from the way that
    /// led on from the last one.
    pub fn resume(&mut self, position: DVec3, seconds: f64) -> Step {
        let last = Mark {
            place: self.place.replace(position).unwrap_or(position),
            velocity: self.velocity,
            age: seconds.min(UNSEEN_SECONDS),
        };
        self.stand();
        Step {
            speed: 0.0,
            has_strayed: last.off(position) > STRAY,
        }
    }

    /// Nothing is known of where it goes.
    fn stand(&mut self) {
        (self.velocity, self.marks) = (DVec3::ZERO, None);
    }

    /// A step to `position` (m), within `seconds`, above zero, at the speed `measured` (m/s).
    pub fn step(&mut self, position: DVec3, seconds: f64, measured: f64) -> Step {
        let last = Mark {
            place: self.place.replace(position).unwrap_or(position),
            velocity: self.velocity,
            age: seconds,
        };
        let [older, recent] = self.marks.map_or([last; 2], |marks| {
            marks.map(|mark| Mark {
                age: mark.age + seconds,
                ..mark
            })
        });
        // Of what was longer ago the course says nothing.
        let judged = [Some(last), (older.age < LONGEST_SECONDS).then_some(older)];
        let offs = judged.into_iter().flatten().map(|mark| mark.off(position));
        let off = offs.fold(0.0, f64::max);
        let has_strayed = off > STRAY;
        if has_strayed {
            self.stand();
            return Step {
                speed: measured.max(off / STRAY_SECONDS),
                has_strayed,
            };
        }
        let found = (position - last.place) / seconds;
        self.velocity = if self.marks.is_some() {
            let share = (seconds / COURSE_SECONDS).min(1.0);
            self.velocity.lerp(found, share)
        } else {
            found.clamp_length_max(FIRST_SPEED)
        };
        let here = Mark {
            place: position,
            velocity: self.velocity,
            age: 0.0,
        };
        self.marks = Some(match self.marks {
            None => [here; 2],
            Some(_) if recent.age >= COURSE_SECONDS => [recent, here],
            Some(_) => [older, recent],
        });
        Step {
            speed: measured,
            has_strayed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hand_that_goes_on_is_on_its_course_and_one_that_jumps_is_not() {
        let mut course = Course::default();
        course.resume(DVec3::ZERO, 0.0);
        for ms in 1..50 {
            let step = course.step(DVec3::X * 1e-3 * f64::from(ms), 1e-3, 1.0);
            assert!(step.speed < 1.0 + 1e-9 && !step.has_strayed);
        }
        // After 15 ms unseen: on its way, stopped on the way, and elsewhere.
        for (metres, strays) in [(0.064, false), (0.055, false), (0.044, true), (0.070, true)] {
            let step = course.clone().step(DVec3::X * metres, 0.015, 1.0);
            assert_eq!(step.has_strayed, strays, "{metres}");
            assert_eq!(step.speed > 2.0, strays, "{metres}");
        }
    }

    #[test]
    fn a_jump_in_parts_is_one() {
        for parts in [2, 3, 4] {
            let mut course = Course::default();
            let mut strayed = false;
            for ms in 0..50 {
                let gone = 7.5e-3 / f64::from(parts) * f64::from((ms - 30).clamp(0, parts));
                strayed |= course.step(DVec3::X * gone, 1e-3, 0.0).has_strayed;
            }
            assert!(strayed, "{parts}");
        }
    }

    #[test]
    fn a_hand_that_starts_at_once_keeps_its_course() {
        for period in [2.5e-4, 1e-3, 2.5e-3, 5e-3] {
            let mut course = Course::default();
            course.resume(DVec3::ZERO, 0.0);
            for k in 0..100 {
                let place = DVec3::X * 0.6 * period * f64::from((k - 40).max(0));
                assert!(!course.step(place, period, 0.0).has_strayed, "{period}");
            }
        }
    }

    #[test]
    fn a_hand_that_starts_and_stops_hard_keeps_its_course() {
        // To and fro by 150 mm, at 1.0 m/s and 7 m/s^2; at each rate.
        for period in [2.5e-4, 1e-3, 2.5e-3, 5e-3, 1e-2] {
            let mut course = Course::default();
            course.resume(DVec3::X * 0.15, 0.0);
            for k in 1..10_000 {
                let place = DVec3::X * 0.15 * (7.0 * period * f64::from(k)).cos();
                let step = course.step(place, period, 0.0);
                assert!(!step.has_strayed, "{period} {k} {step:?}");
            }
        }
    }

    #[test]
    fn after_an_interruption_only_what_is_near_has_been_reached() {
        let mut course = Course::default();
        assert_eq!(course.resume(DVec3::Y, 0.0), Step::default(), "set down");
        course.interrupt();
        assert!(!course.resume(DVec3::Y * 1.003, 0.03).has_strayed);
        course.interrupt();
        assert!(course.resume(DVec3::Y * 1.008, 0.03).has_strayed);
        course.reset();
        assert!(!course.resume(DVec3::ZERO, 0.03).has_strayed);
    }

    #[test]
    fn a_hand_out_of_sight_goes_on_or_stops_but_does_not_turn() {
        let mut course = Course::default();
        course.resume(DVec3::ZERO, 0.0);
        for ms in 1..50 {
            course.step(DVec3::X * 5e-4 * f64::from(ms), 1e-3, 0.5);
        }
        course.interrupt();
        // 0.5 m/s for 30 ms; for a second no way of 0.5 m is believed.
        for (millimetres, seconds, strays) in [
            (39.0, 0.03, false),
            (26.0, 0.03, false),
            (45.0, 0.03, true),
            (14.5, 0.03, true),
            (74.0, 1.0, false),
            (80.0, 1.0, true),
        ] {
            let place = DVec3::X * 1e-3 * millimetres;
            let step = course.clone().resume(place, seconds);
            assert_eq!(step.has_strayed, strays, "{millimetres} {seconds}");
        }
        // Who knows where it goes when it is back.
        course.resume(DVec3::X * 0.03, 0.03);
        course.interrupt();
        assert!(course.resume(DVec3::X * 0.04, 0.03).has_strayed);
    }
}
