//! Speed from coarse positions: over some milliseconds, as one encoder count is a third of one.

use glam::DVec3;

/// Speeds are measured over at least this time, s.
const WINDOW_SECONDS: f64 = 0.005;

/// Remembers where the handle was five to ten milliseconds ago.
#[derive(Debug, Clone, Copy, Default)]
pub struct WindowSpeed {
    marks: Option<[(f64, DVec3); 2]>,
}

impl WindowSpeed {
    /// Forgets the past, for after a gap.
    pub fn reset(&mut self) {
        self.marks = None;
    }

    /// Speed (m/s) at `position` (m) and time `now` (s).
    pub fn speed(&mut self, position: DVec3, now: f64) -> f64 {
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
