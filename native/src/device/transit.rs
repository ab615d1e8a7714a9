//! How long messages take, as far as that says something of the device's clock.

/// The shortest time counts for one to two times as long, s: clocks drift.
const WINDOW_SECONDS: f64 = 0.25;
/// A longer pause is a host that was held up, s.
const GAP_SECONDS: f64 = 0.02;

/// The shortest time that a message took lately: none was made later than that before it came.
#[derive(Debug, Clone, Copy)]
pub struct Transit {
    /// The device's time as far as it is believed, s.
    made: f64,
    /// Arrival of the messages that came last, and the shortest time from `made` until then, s.
    last: Option<(f64, f64)>,
    /// The shortest of those before, in this quarter of a second and in the one before it.
    shortest: [f64; 2],
    /// How long this quarter has lasted, s; a host that was held up looks like a moment.
    lasts: f64,
}

impl Default for Transit {
    fn default() -> Self {
        Self {
            made: 0.0,
            last: None,
            shortest: [f64::INFINITY; 2],
            lasts: 0.0,
        }
    }
}

impl Transit {
    /// Longest time since the last message that one which comes at `now` (s) can tell of. What comes
    /// together says nothing of itself.
    pub fn allows(&self, now: f64) -> Option<f64> {
        let [this, before] = self.shortest;
        let last = self.last.filter(|(came, _)| *came != now);
        let shortest = last.map_or(f64::INFINITY, |(_, shortest)| shortest);
        let shortest = shortest.min(this).min(before);
        shortest.is_finite().then_some(now - shortest - self.made)
    }

    /// The message that came at `now` (s) was made `seconds` after the last one.
    pub fn goes_on(&mut self, now: f64, seconds: f64) {
        self.made += seconds;
        let taken = now - self.made;
        match self.last.replace((now, taken)) {
            Some((came, shortest)) if came == now => self.last = Some((now, taken.min(shortest))),
            Some((came, shortest)) => {
                self.shortest[0] = self.shortest[0].min(shortest);
                self.lasts += (now - came).clamp(0.0, GAP_SECONDS);
            }
            None => {}
        }
        if self.lasts > WINDOW_SECONDS {
            self.shortest = [f64::INFINITY, self.shortest[0]];
            self.lasts = 0.0;
        }
    }
}
