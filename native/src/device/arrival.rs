//! Arrivals of STATE beside the times at which the device made them: a wire that holds bytes back
//! is told by them.
//!
//! FTDI's USB serial adapters keep what they receive until a timer ends, 16 ms as delivered: STATE
//! made every millisecond then arrives in bursts, 62.5 a second (FTDI, application note AN232B-04,
//! "Data Throughput, Latency and Handshaking").

/// A shorter pause is ordinary jitter, s.
const BURST_PAUSE: f64 = 3.5e-3;
/// Fewer at once may come together by chance.
const BURST_STATES: u32 = 3;
/// After a longer pause the line was silent, which is another fault, s.
const SILENCE: f64 = 0.5;

/// Counters so far.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ArrivalReport {
    /// Pauses from one tick with new STATEs to the next.
    pub pauses: u64,
    /// Their sum, s.
    pub pause_seconds: f64,
    /// The longest, s.
    pub longest_pause: f64,
    /// STATEs that ended a pause.
    pub states: u64,
    /// Time that went by between them on the device's own clock, s.
    pub device_seconds: f64,
    /// Bursts: pauses in which the device made STATEs and nothing came.
    pub bursts: u64,
    /// Their pauses' sum, s.
    pub burst_seconds: f64,
    /// STATEs that came in bursts.
    pub burst_states: u64,
}

/// STATEs of one tick.
#[derive(Debug, Clone, Copy)]
struct Batch {
    count: u32,
    first_us: u32,
    last_us: u32,
}

/// Watches the arrivals, a tick at a time.
#[derive(Debug, Clone, Default)]
pub struct Arrivals {
    batch: Option<Batch>,
    /// Time of the last batch, s, and the device's clock in its last STATE.
    last: Option<(f64, u32)>,
    /// The last tick that looked in vain, s.
    in_vain: f64,
    /// Counters so far.
    pub report: ArrivalReport,
}

fn device_seconds(from_us: u32, to_us: u32) -> f64 {
    f64::from(to_us.wrapping_sub(from_us)) * 1e-6
}

impl Arrivals {
    /// A STATE came in this tick, made at `time_us` by the device's clock.
    pub fn take(&mut self, time_us: u32) {
        let batch = self.batch.get_or_insert(Batch {
            count: 0,
            first_us: time_us,
            last_us: time_us,
        });
        batch.count += 1;
        batch.last_us = time_us;
    }

    /// All that had come at `now` (s) was taken.
    pub fn end_of_tick(&mut self, now: f64) {
        let Some(batch) = self.batch.take() else {
            self.in_vain = now;
            return;
        };
        if let Some((then, then_us)) = self.last.replace((now, batch.last_us)) {
            let pause = now - then;
            if pause <= SILENCE {
                self.count(&batch, pause, device_seconds(then_us, batch.last_us));
                // A host that was held up itself has not looked in vain; a device that was held up
                // has made nothing to hold back.
                let silence = self.in_vain - then;
                let made = device_seconds(batch.first_us, batch.last_us);
                if silence >= BURST_PAUSE && batch.count >= BURST_STATES && made >= 0.5 * pause {
                    self.report.bursts += 1;
                    self.report.burst_seconds += pause;
                    self.report.burst_states += u64::from(batch.count);
                }
            }
        }
    }

    fn count(&mut self, batch: &Batch, pause: f64, made_in: f64) {
        let report = &mut self.report;
        report.pauses += 1;
        report.pause_seconds += pause;
        report.longest_pause = report.longest_pause.max(pause);
        // A device that was reset begins its clock anew.
        if made_in <= 2.0 * SILENCE {
            report.states += u64::from(batch.count);
            report.device_seconds += made_in;
        }
    }

    /// The line was closed.
    pub fn forget(&mut self) {
        (self.batch, self.last) = (None, None);
    }
}
