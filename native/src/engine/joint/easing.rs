//! Which part of the way pushes turn from one linearisation to the next.
//!
//! Beside a tool's edge its normal turns with the point that is pushed, and the push turns the point
//! back: pushes go to and fro between two directions, each of which the other one's forces ask for.
//! A part of the way ends where the whole does, and gets there. What lies along such a direction is
//! still clear of the tool: any half-space that holds the whole tool is.

/// So many linearisations go all of the way: as many as a tick of 1 kHz makes.
const WHOLE: usize = 6;
/// One that leaves less than this share of the error before it helps.
const HELPS: f64 = 0.7;
/// Else the next one goes by this share of its part of the way, down to the least part.
const SHORTER: f64 = 0.7;
const LEAST: f64 = 0.05;
/// And by so many times as much after one that helps.
const LONGER: f64 = 1.2;

/// The part of the way in a tick, and what tells it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Easing {
    pub part: f64,
    error: f64,
}

impl Default for Easing {
    /// All of the way.
    fn default() -> Self {
        Self {
            part: 1.0,
            error: f64::INFINITY,
        }
    }
}

impl Easing {
    /// Learns what error a linearisation has left, of which so many were made.
    pub(crate) fn learn(&mut self, made: usize, error: f64) {
        if made <= WHOLE {
            return;
        }
        self.part = if error > HELPS * self.error {
            (SHORTER * self.part).max(LEAST)
        } else {
            (LONGER * self.part).min(1.0)
        };
        self.error = error;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_to_and_fro_comes_to_rest() {
        // x -> -x: each linearisation of the whole way leaves as much as there was.
        let (mut easing, mut x) = (Easing::default(), 1.0_f64);
        for made in 1..=40 {
            let asked = -x;
            easing.learn(made, (asked - x).abs());
            x += easing.part * (asked - x);
        }
        assert!(x.abs() < 1e-6, "{x}");
    }

    #[test]
    fn what_comes_nearer_goes_all_of_the_way() {
        let mut easing = Easing::default();
        for made in 1..=40 {
            easing.learn(made, 0.5_f64.powi(made as i32));
        }
        assert!(easing.part == 1.0);
    }
}
