//! FORCE on its way, and whether the device hears it in time.
//!
//! STATE names the last FORCE that was taken. The time from sending one until it is named is the time
//! of both directions together, whatever either does: a device that does not read, a line that stores,
//! a STATE that was made long ago all make it long.

/// What was not named for so long is late, s.
const FRESH_SECONDS: f64 = 0.02;
/// The last sign of it must be so long ago before the device is believed to hear again, s.
const DEAF_SECONDS: f64 = 0.1;
/// FORCE of which nothing was heard yet, at most: more would only wait on the way.
const MOST_IN_FLIGHT: usize = 4;
/// Longest pause between two zeros to a device that takes none, s.
const LONGEST_PAUSE: f64 = 1.0;
const REMEMBERED: usize = 16;
/// Part of each new round trip that is taken.
const SHARE: f64 = 0.1;

/// FORCE sent and not named yet, oldest first, and what is known of the round trip.
#[derive(Debug, Clone, Copy)]
pub struct Freshness {
    sent: [(u16, f64); REMEMBERED],
    count: usize,
    /// The last sign that the device hears late, s.
    late_at: f64,
    /// Averaged, s.
    round_trip: Option<f64>,
}

impl Default for Freshness {
    fn default() -> Self {
        Self {
            sent: [(0, 0.0); REMEMBERED],
            count: 0,
            late_at: f64::NEG_INFINITY,
            round_trip: None,
        }
    }
}

impl Freshness {
    /// What was sent before is not waited for: there was nobody, or the host itself was away.
    pub fn forget(&mut self) {
        self.count = 0;
    }

    /// Whether another FORCE may leave. One that *pushes* not behind others that may all be waiting; a
    /// zero now and then, each pause twice as long.
    pub fn may_send(&self, pushes: bool, now: f64) -> bool {
        let Some((_, newest)) = self.sent[..self.count].last() else {
            return true;
        };
        let pause = (newest - self.sent[0].1).clamp(FRESH_SECONDS, LONGEST_PAUSE);
        self.count < MOST_IN_FLIGHT || (!pushes && now - newest >= pause)
    }

    /// A FORCE left.
    pub fn send(&mut self, sequence: u16, now: f64) {
        if self.count == REMEMBERED {
            // The oldest tells since when nothing was heard.
            self.sent.copy_within(2.., 1);
            self.count -= 1;
        }
        self.sent[self.count] = (sequence, now);
        self.count += 1;
    }

    /// A STATE came that names this FORCE as the last one taken.
    pub fn hear(&mut self, sequence: u16, now: f64) {
        let mut sent = self.sent[..self.count].iter();
        let Some(named) = sent.position(|(sent, _)| *sent == sequence) else {
            return;
        };
        let seconds = now - self.sent[named].1;
        let before = self.round_trip.unwrap_or(seconds);
        self.round_trip = Some(before + SHARE * (seconds - before));
        if seconds > FRESH_SECONDS {
            self.late_at = now;
        }
        // Those before it were lost.
        self.sent.copy_within(named + 1..self.count, 0);
        self.count -= named + 1;
    }

    /// The port takes nothing.
    pub fn refuse(&mut self, now: f64) {
        self.late_at = now;
    }

    /// Whether the device does not hear in time, or did not a moment ago.
    pub fn is_deaf(&mut self, now: f64) -> bool {
        if self.count > 0 && now - self.sent[0].1 > FRESH_SECONDS {
            self.late_at = now;
        }
        now - self.late_at < DEAF_SECONDS
    }

    /// FORCE that no STATE has named yet.
    pub fn in_flight(&self) -> usize {
        self.count
    }

    /// Time from a FORCE to the STATE that names it, averaged, s; None as long as there was none.
    pub fn round_trip(&self) -> Option<f64> {
        self.round_trip
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 kHz; a FORCE is named this many ticks after it was sent, for so many ticks from 0 on.
    fn told(ticks: u16, lag: impl Fn(u16) -> u16) -> (Freshness, Vec<bool>) {
        let mut freshness = Freshness::default();
        let mut sent = Vec::new();
        let deaf = (0..ticks)
            .map(|tick| {
                let now = f64::from(tick) * 1e-3;
                let named = sent.iter().rfind(|at| **at + lag(**at) <= tick);
                if let Some(sequence) = named {
                    freshness.hear(*sequence, now);
                }
                let deaf = freshness.is_deaf(now);
                if freshness.may_send(!deaf, now) {
                    freshness.send(tick, now);
                    sent.push(tick);
                }
                assert!(freshness.in_flight() <= REMEMBERED);
                deaf
            })
            .collect();
        (freshness, deaf)
    }

    #[test]
    fn a_line_that_is_quick_enough_is_never_deaf_and_one_that_lags_always() {
        for lag in [1, 2, 5, 19] {
            let (freshness, deaf) = told(1000, |_| lag);
            assert!(deaf.iter().all(|deaf| !deaf), "{lag}");
            let round_trip = freshness.round_trip().expect("it was named");
            assert!((round_trip - f64::from(lag) * 1e-3).abs() < 1e-9);
        }
        for lag in [22, 50, 200, 500] {
            let (_, deaf) = told(3000, |_| lag);
            let first = deaf.iter().position(|deaf| *deaf).expect("deaf");
            assert!((20..=22).contains(&first), "{lag}: {first}");
            assert!(deaf[first..].iter().all(|deaf| *deaf), "{lag}");
        }
    }

    #[test]
    fn a_device_that_reads_nothing_for_three_seconds_is_deaf_at_once_and_hears_again_soon() {
        // What is sent between 500 and 3500 is taken at 3500.
        let lag = |at: u16| {
            if (500..3500).contains(&at) {
                3500 - at
            } else {
                2
            }
        };
        let (_, deaf) = told(5000, lag);
        assert!(deaf[..500].iter().all(|deaf| !deaf));
        let first = deaf.iter().position(|deaf| *deaf).expect("deaf");
        assert!(first <= 521, "{first}");
        assert!(deaf[first..3590].iter().all(|deaf| *deaf));
        assert!(deaf[3620..].iter().all(|deaf| !deaf));
    }

    #[test]
    fn at_most_four_wait_to_be_heard_and_a_zero_now_and_then() {
        let mut freshness = Freshness::default();
        let mut pushes = 0;
        let mut zeros = 0;
        for tick in 0..3000_u16 {
            let now = f64::from(tick) * 1e-3;
            let deaf = freshness.is_deaf(now);
            if freshness.may_send(!deaf, now) {
                freshness.send(tick, now);
                *if deaf { &mut zeros } else { &mut pushes } += 1;
            }
        }
        assert_eq!(pushes, 4);
        assert!((4..=9).contains(&zeros), "{zeros}");
    }

    #[test]
    fn what_was_lost_on_the_way_is_forgotten_with_the_next_that_was_heard() {
        let mut freshness = Freshness::default();
        for sequence in [65_534, 65_535, 0] {
            freshness.send(sequence, 0.0);
        }
        freshness.hear(7, 0.001);
        assert_eq!(freshness.in_flight(), 3, "never sent");
        freshness.hear(65_535, 0.002);
        assert_eq!(freshness.in_flight(), 1);
        assert!(!freshness.is_deaf(0.02) && freshness.is_deaf(0.021));
    }
}
