//! Stillness of forces that are stepped without a clock.

/// Forces have settled when they change by less than this share of the largest one in a tick.
pub(super) const SETTLED: f64 = 1e-11;
/// In so many ticks one after the other.
const QUIET_TICKS: usize = 3;
/// Where rounding keeps contact points coming and going, forces never settle; nobody sees or feels a
/// change by less than this share, for all of the second half of their time.
const STILL: f64 = 1e-7;
/// Ticks that a place is given to settle.
pub(super) const MOST_TICKS: usize = 5000;

/// For how many ticks up to now forces have changed little.
#[derive(Debug, Default)]
pub(super) struct Stillness {
    quiet: usize,
    still: usize,
}

impl Stillness {
    /// One tick more, in which forces changed by a share of the largest one.
    pub fn take(&mut self, change: f64) {
        self.quiet = if change <= SETTLED { self.quiet + 1 } else { 0 };
        self.still = if change <= STILL { self.still + 1 } else { 0 };
    }

    /// Whether forces have settled, or are as good as settled.
    pub fn is_reached(&self) -> bool {
        self.quiet >= QUIET_TICKS || self.still >= MOST_TICKS / 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After how many ticks forces rest, whose changes are these for ever.
    fn ticks_to_rest(changes: &[f64]) -> Option<usize> {
        let mut stillness = Stillness::default();
        (1..=MOST_TICKS).find(|tick| {
            stillness.take(changes[tick % changes.len()]);
            stillness.is_reached()
        })
    }

    #[test]
    fn forces_that_stay_rest_at_once() {
        assert_eq!(ticks_to_rest(&[0.0]), Some(QUIET_TICKS));
        assert_eq!(ticks_to_rest(&[0.0, 0.0, 1e-3]), None);
    }

    #[test]
    fn forces_that_only_rounding_moves_rest_in_the_end() {
        assert_eq!(ticks_to_rest(&[2.6e-9, 1e-12]), Some(MOST_TICKS / 2));
        assert_eq!(ticks_to_rest(&[2.6e-9, 1e-6]), None);
    }
}
