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
/// No course is faster, m/s.
const FASTEST: f64 = STRAY / STRAY_SECONDS;

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

/// Time of a step, s; above zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elapsed {
    /// As far as it is known.
    pub seconds: f64,
    /// Longest that it may have been.
    pub most: f64,
}

impl Elapsed {
    /// A time that is known.
    pub fn of(seconds: f64) -> Self {
        let most = seconds;
        Self { seconds, most }
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
    /// The same `seconds` later.
    fn later(self, seconds: f64) -> Self {
        let age = self.age + seconds;
        Self { age, ..self }
    }

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

    fn mark(&self, place: DVec3) -> Mark {
        Mark {
            place,
            velocity: self.velocity,
            age: 0.0,
        }
    }

    /// Nothing is known of where it goes.
    fn stand(&mut self) {
        (self.velocity, self.marks) = (DVec3::ZERO, None);
    }

    /// A step to `position` (m), within that time, at the speed `measured` (m/s).
    pub fn step(&mut self, position: DVec3, elapsed: Elapsed, measured: f64) -> Step {
        let Elapsed { seconds, most } = elapsed;
        let before = self.place.replace(position).unwrap_or(position);
        let last = self.mark(before);
        let marks = self.marks.unwrap_or([last; 2]);
        // Of what was longer ago the course says nothing.
        let is_held_to = marks[0].age + seconds < LONGEST_SECONDS;
        let judged = [Some(last), is_held_to.then_some(marks[0])];
        let judged = judged.into_iter().flatten();
        let offs = judged.map(|mark| mark.later(most).off(position));
        let off = offs.fold(0.0, f64::max);
        if off <= STRAY {
            self.go_on(
                &last,
                marks.map(|mark| mark.later(seconds)),
                position,
                seconds,
            );
            return Step {
                speed: measured,
                has_strayed: false,
            };
        }
        // In a longer time a hand may have got there too: nobody knows how.
        let is_jump = most < LONGEST_SECONDS;
        if is_jump {
            self.stand();
        } else {
            self.velocity = ((position - last.place) / most).clamp_length_max(FASTEST);
            self.marks = Some([self.mark(position); 2]);
        }
        let least = if is_jump { off / STRAY_SECONDS } else { 0.0 };
        Step {
            speed: measured.max(least),
            has_strayed: true,
        }
    }

    /// Learns where the way leads from one that was on its course.
    fn go_on(&mut self, last: &Mark, marks: [Mark; 2], position: DVec3, seconds: f64) {
        let found = (position - last.place) / seconds;
        self.velocity = if self.marks.is_some() {
            let share = (seconds / COURSE_SECONDS).min(1.0);
            let velocity = self.velocity.lerp(found, share);
            velocity.clamp_length_max(FASTEST)
        } else {
            found.clamp_length_max(FIRST_SPEED)
        };
        let here = self.mark(position);
        let [older, recent] = marks;
        self.marks = Some(match self.marks {
            None => [here; 2],
            Some(_) if recent.age >= COURSE_SECONDS => [recent, here],
            Some(_) => [older, recent],
        });
    }
}
