//! When a FORCE may leave: no faster than STATE comes, and not behind another one that waits.
//!
//! A FORCE is shorter than a STATE. A line that is as fast in both directions is therefore never
//! overfilled by one FORCE for each STATE, whatever its speed, which need not be known.

/// Without STATE the last word is said again this often at most, s: half of what a device waits for.
const REPEAT_SECONDS: f64 = 0.01;
/// And not before a STATE is late by half of the usual time.
const REPEAT_INTERVALS: f64 = 1.5;
/// Time between STATE as long as nothing is known of it, and the longest that is believed, s.
const UNKNOWN_SECONDS: f64 = 0.025;
const LONGEST_SECONDS: f64 = 0.05;
/// Part of each new interval that is taken.
const SHARE: f64 = 0.05;
/// A STATE that comes this many ticks after the one before, on average, or sooner, may share a tick
/// with it and leave the next one without.
const DENSE_TICKS: f64 = 1.5;
/// Of the shortest STATE on the line.
const STATE_BYTES: f64 = 25.0;
/// Bits that a byte takes on the line.
const BITS: f64 = 10.0;

/// Paces FORCE.
#[derive(Debug, Clone, Copy)]
pub struct Pacing {
    /// STATE that no FORCE was sent for.
    credit: u32,
    /// Of STATE, on average, s; None before the second.
    interval: Option<f64>,
    heard: f64,
    sent: f64,
    /// Until then the line carries what was sent, s.
    busy_until: f64,
    is_speed_known: bool,
}

impl Default for Pacing {
    fn default() -> Self {
        Self {
            credit: 0,
            interval: None,
            heard: f64::NEG_INFINITY,
            sent: f64::NEG_INFINITY,
            busy_until: f64::NEG_INFINITY,
            is_speed_known: false,
        }
    }
}

impl Pacing {
    /// A STATE came at `now`, s; ticks come every `dt`.
    pub fn hear(&mut self, now: f64, dt: f64) {
        let gap = (now - self.heard).clamp(0.0, LONGEST_SECONDS);
        if self.interval.is_none() && !self.is_speed_known {
            // What was reckoned before is too much: FORCE takes less time than a STATE.
            self.busy_until = self.sent + gap;
        }
        self.interval = match self.interval {
            _ if self.heard == f64::NEG_INFINITY => None,
            None => Some(gap),
            Some(interval) => Some(interval + SHARE * (gap - interval)),
        };
        self.heard = now;
        let most = if self.is_dense(dt) { 2 } else { 1 };
        self.credit = (self.credit + 1).min(most);
        if self.is_dense(dt) && !self.is_speed_known {
            // What was reckoned while little was known of the line.
            self.busy_until = f64::NEG_INFINITY;
        }
    }

    fn is_dense(&self, dt: f64) -> bool {
        self.interval
            .is_some_and(|seconds| seconds <= DENSE_TICKS * dt)
    }

    /// Whether a FORCE may leave now: one for each STATE, and now and then without one, or a device
    /// whose STATE are lost would take the host for lost; not before the line has carried what it was
    /// given, to half a tick.
    pub fn is_due(&self, now: f64, dt: f64) -> bool {
        let interval = self.interval.unwrap_or(UNKNOWN_SECONDS);
        let is_late = now - self.sent >= (REPEAT_INTERVALS * interval).max(REPEAT_SECONDS);
        self.is_free(now, dt) && (self.credit > 0 || is_late)
    }

    /// Whether a line of known speed has carried what it was given; any other is believed to.
    pub fn has_carried(&self, now: f64, dt: f64) -> bool {
        !self.is_speed_known || self.is_free(now, dt)
    }

    fn is_free(&self, now: f64, dt: f64) -> bool {
        self.busy_until <= now + 0.5 * dt
    }

    /// A FORCE left.
    pub fn send(&mut self, now: f64) {
        self.credit = self.credit.saturating_sub(1);
        self.sent = now;
    }

    /// So many bytes were given to a line of `bits_per_second`. Where that is not known, the line is
    /// at least as fast as STATE comes.
    pub fn carry(&mut self, bytes: usize, bits_per_second: Option<u32>, now: f64, dt: f64) {
        self.is_speed_known = bits_per_second.is_some();
        let a_byte = match bits_per_second {
            Some(speed) => BITS / f64::from(speed),
            None if self.is_dense(dt) => 0.0,
            None => self.interval.unwrap_or(UNKNOWN_SECONDS) / STATE_BYTES,
        };
        self.busy_until = self.busy_until.max(now) + bytes as f64 * a_byte;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-3;
    const FORCE_BYTES: usize = 14;

    /// Longest wait of a FORCE behind others on a line of this speed that carries both directions
    /// alike, s: STATE as fast as it goes, at most `rate_hz`; the host was held up now and then.
    fn longest_wait(baud: f64, rate_hz: f64) -> (f64, u32) {
        let seconds = |bytes: f64| bytes * BITS / baud;
        let mut pacing = Pacing::default();
        let (mut arrives, mut line_free, mut longest, mut sent) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
        for tick in 0..20_000_u32 {
            if (500..515).contains(&(tick % 997)) {
                continue;
            }
            let now = f64::from(tick) * DT;
            while arrives <= now {
                pacing.hear(now, DT);
                arrives += seconds(STATE_BYTES).max(1.0 / rate_hz);
            }
            if pacing.is_due(now, DT) {
                pacing.send(now);
                pacing.carry(FORCE_BYTES, None, now, DT);
                sent += 1;
                longest = longest.max(line_free - now);
                line_free = line_free.max(now) + seconds(FORCE_BYTES as f64);
            }
        }
        (longest, sent)
    }

    #[test]
    fn a_force_waits_at_most_a_tick_behind_another_at_any_speed_of_a_symmetric_line() {
        for baud in [9_600.0, 19_200.0, 57_600.0, 115_200.0, 250_000.0, 1e6] {
            for rate_hz in [100.0, 400.0, 777.0, 1000.0] {
                let (longest, sent) = longest_wait(baud, rate_hz);
                assert!(longest <= DT, "{baud} {rate_hz}: {longest}");
                let states = rate_hz.min(baud / BITS / STATE_BYTES) * 20.0;
                assert!(f64::from(sent) > 0.9 * states, "{sent} of {states}");
            }
        }
    }

    #[test]
    fn clocks_that_drift_cost_no_force() {
        // 1 kHz by either clock, but now two STATE in a tick and now none.
        let mut pacing = Pacing::default();
        let mut sent = 0;
        for tick in 0..4000_u32 {
            let now = f64::from(tick) * DT;
            for _ in 0..[2, 0, 1, 1][tick as usize % 4] {
                pacing.hear(now, DT);
            }
            if pacing.is_due(now, DT) {
                pacing.send(now);
                sent += 1;
            }
        }
        assert!(sent > 3900, "{sent}");
    }

    #[test]
    fn without_state_the_last_word_is_said_again_and_not_often() {
        let mut pacing = Pacing::default();
        for tick in 0..1000_u32 {
            pacing.hear(f64::from(tick) * DT, DT);
        }
        pacing.send(1.0);
        pacing.send(1.0);
        assert!(!pacing.is_due(1.005, DT) && pacing.is_due(1.011, DT));
        let said = (0..1000_u32)
            .filter(|tick| {
                let now = 5.0 + f64::from(*tick) * DT;
                let is_due = pacing.is_due(now, DT);
                if is_due {
                    pacing.send(now);
                }
                is_due
            })
            .count();
        assert!((90..=100).contains(&said), "{said}");
    }

    #[test]
    fn a_line_whose_speed_is_known_is_given_one_message_at_a_time() {
        let mut pacing = Pacing::default();
        pacing.hear(0.0, DT);
        assert!(pacing.is_due(0.0, DT));
        // 14 bytes at 9600 baud are 14.6 ms.
        pacing.carry(FORCE_BYTES, Some(9_600), 0.0, DT);
        assert!(!pacing.is_due(0.014, DT) && pacing.is_due(0.0142, DT));
    }
}
