//! What does not come to rest but goes to and fro about one place, as what sticks and slips on rough floors does.

use super::placement::Placement;

/// In so many ticks changes have to become slower, or it does not come nearer to rest.
const WAVERING_TICKS: usize = 8;
/// After so many ticks it rests where it stays for so many more: where it has gone by no more than this share of
/// what its largest force would have taken it by, and not by this share of its size.
const PATIENCE: usize = 60;
const STAYING_TICKS: usize = 20;
const STAYS: f64 = 1e-5;
const FARTHEST: f64 = 1e-4;

/// Of what hardly moves any more.
#[derive(Debug, Clone, Default)]
pub(super) struct Wavering {
    ticks: usize,
    /// How fast forces changed before them, as a share of the largest, 1/s.
    rate: f64,
}

impl Wavering {
    /// Whether it has hardly moved for long and comes no nearer to rest; `rate`: how fast forces change.
    pub(super) fn is_over(&mut self, hardly_moves: bool, rate: f64) -> bool {
        if !hardly_moves {
            self.ticks = 0;
            return false;
        }
        if self.ticks == 0 {
            self.rate = rate;
        }
        self.ticks += 1;
        if self.ticks <= WAVERING_TICKS {
            return false;
        }
        self.ticks = 0;
        rate >= self.rate
    }
}

/// Where bodies are now.
#[derive(Debug, Clone)]
pub(super) struct Now {
    /// Since the beginning.
    pub tick: usize,
    /// Seconds.
    pub since: f64,
    /// Of each.
    pub at: Vec<Placement>,
    /// Metres.
    pub size: f64,
    /// At which the largest force would take one of them, m/s.
    pub speed: f64,
}

/// Of what moves, but not away.
#[derive(Debug, Clone, Default)]
pub(super) struct Staying(Option<Now>);

impl Staying {
    /// Whether bodies have long stayed about one place; `now` is none where they are led elsewhere.
    pub(super) fn is_over(&mut self, now: Option<Now>) -> bool {
        let now = now.filter(|now| now.tick >= PATIENCE);
        if let (Some(then), Some(now)) = (&self.0, &now) {
            let gone = gone(then, now);
            if gone <= FARTHEST * now.size {
                let taken = STAYS * now.speed * (now.since - then.since);
                return now.tick >= then.tick + STAYING_TICKS && gone <= taken;
            }
        }
        self.0 = now;
        false
    }
}

/// How far a body has gone or turned at most, m.
fn gone(then: &Now, now: &Now) -> f64 {
    then.at.iter().zip(&now.at).fold(0.0, |most, (a, b)| {
        let turned = a.rotation.angle_between(b.rotation) * now.size;
        most.max(a.position.distance(b.position)).max(turned)
    })
}
