//! Speed from coarse positions: over some milliseconds, as one encoder count is a third of one.
//!
//! A 2DIY has no clock. Its answers were measured between request and arrival, and both times are the
//! host's: a host that was held up finds an old answer late, and asks late for the next one.

use glam::DVec3;

use crate::device::course::{Course, Elapsed, Step};
use crate::device::haply::flight::Moment;

/// Answers that come together were made this long after each other at least, s.
const TOGETHER_SECONDS: f64 = 5e-4;
/// Speeds are measured over at least this time, s.
const WINDOW_SECONDS: f64 = 0.005;

/// Remembers where the handle was five to ten milliseconds ago.
#[derive(Debug, Clone, Copy, Default)]
pub struct WindowSpeed {
    marks: Option<[(Moment, DVec3); 2]>,
    course: Course,
    last: Option<Moment>,
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

    /// Longest time from the last place to that moment, s.
    pub fn since(&self, moment: &Moment) -> f64 {
        self.last.map_or(0.0, |last| longest(&last, moment))
    }

    /// The step to `position` (m), where the handle was at that moment.
    pub fn step(&mut self, position: DVec3, moment: Moment) -> Step {
        let is_first = self.marks.is_none();
        let measured = self.speed(position, moment);
        let last = self.last.replace(moment).unwrap_or(moment);
        let most = longest(&last, &moment).max(TOGETHER_SECONDS);
        if is_first {
            self.course.resume(position, most)
        } else {
            let seconds = (moment.asked - last.asked).max(TOGETHER_SECONDS);
            let elapsed = Elapsed { seconds, most };
            self.course.step(position, elapsed, measured)
        }
    }

    fn speed(&mut self, position: DVec3, moment: Moment) -> f64 {
        let here = (moment, position);
        let [_, recent] = *self.marks.get_or_insert([here; 2]);
        if moment.asked - recent.0.asked >= WINDOW_SECONDS {
            self.marks = Some([recent, here]);
        }
        let [(then, from), _] = self.marks.unwrap_or([recent; 2]);
        if position == from {
            return 0.0;
        }
        position.distance(from) / longest(&then, &moment).max(WINDOW_SECONDS)
    }
}

/// Longest time between two answers, s: requests and answers may both have been held up on their way.
fn longest(from: &Moment, to: &Moment) -> f64 {
    (to.asked - from.asked).max(to.came - from.came)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of a handle that goes at 1 m/s; each answer is measured 1 ms after its request, and the host
    /// looks after so many milliseconds.
    fn steps(looks: &[u32]) -> Vec<Step> {
        let mut speed = WindowSpeed::default();
        let mut asked = 0;
        let step = |pause: &u32| {
            let [then, now] = [asked, asked + pause].map(|ms| f64::from(ms) * 1e-3);
            asked += pause;
            let moment = Moment {
                asked: then,
                came: now,
            };
            speed.step(DVec3::X * (then + 1e-3), moment)
        };
        looks.iter().map(step).collect()
    }

    #[test]
    fn a_host_that_was_held_up_makes_no_speed_and_no_jump() {
        let mut looks = Vec::new();
        for pause in 1..=15 {
            looks.extend([[1; 10].as_slice(), &[pause; 3]].concat());
        }
        for step in steps(&looks) {
            assert!(step.speed < 1.0 + 1e-6 && !step.has_strayed, "{step:?}");
        }
    }

    #[test]
    fn a_speed_is_measured_whatever_the_host_does() {
        let mut speed = WindowSpeed::default();
        let mut found: f64 = 0.0;
        for ms in 0..40 {
            let [asked, came] = [ms, ms + 1].map(|ms| f64::from(ms) * 1e-3);
            let moment = Moment { asked, came };
            found = speed.step(DVec3::X * 3.0 * asked, moment).speed;
        }
        assert!((found - 3.0).abs() < 1e-6, "{found}");
    }
}
