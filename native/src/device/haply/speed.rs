//! Speed from coarse positions: over some milliseconds, as one encoder count is a third of one.

use glam::DVec3;

use crate::device::course::{Course, Step};

/// Answers that come together were made this long after each other at least, s.
const TOGETHER_SECONDS: f64 = 5e-4;
/// Speeds are measured over at least this time, s.
const WINDOW_SECONDS: f64 = 0.005;

/// Remembers where the handle was five to ten milliseconds ago.
#[derive(Debug, Clone, Copy, Default)]
pub struct WindowSpeed {
    marks: Option<[(f64, DVec3); 2]>,
    course: Course,
    /// Time of the last place, s.
    then: f64,
}

impl WindowSpeed {
    /// Forgets the past.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// The handle is out of sight.
    pub fn interrupt(&mut self) {
        self.marks = None;
        self.course.interrupt();
    }

    /// The step to `position` (m) at the time `now` (s).
    pub fn step(&mut self, position: DVec3, now: f64) -> Step {
        let is_first = self.marks.is_none();
        let measured = self.speed(position, now);
        let seconds = (now - std::mem::replace(&mut self.then, now)).max(TOGETHER_SECONDS);
        if is_first {
            self.course.resume(position, seconds)
        } else {
            self.course.step(position, seconds, measured)
        }
    }

    fn speed(&mut self, position: DVec3, now: f64) -> f64 {
        let [_, recent] = *self.marks.get_or_insert([(now, position); 2]);
        if now - recent.0 >= WINDOW_SECONDS {
            self.marks = Some([recent, (now, position)]);
        }
        let [(then, from), _] = self.marks.unwrap_or([recent; 2]);
        if position == from {
            return 0.0;
        }
        position.distance(from) / (now - then).max(WINDOW_SECONDS)
    }
}
