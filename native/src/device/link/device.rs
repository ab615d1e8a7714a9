//! The serial device: the host's end of the link, with all that goes wrong on a wire.

use glam::DVec3;

use crate::device::arrival::Arrivals;
use crate::device::link::codec::Decoder;
use crate::device::link::doubt::Doubt;
use crate::device::link::freshness::Freshness;
use crate::device::link::messages::PROTOCOL;
use crate::device::link::newest::Newest;
use crate::device::link::orientation::Orientations;
use crate::device::link::pacing::Pacing;
use crate::device::reason;
use crate::device::serial::line::Line;
use crate::device::serial::wire::Opener;
use crate::device::speedometer::Speedometer;
use crate::device::{Device, DeviceFrame, Fault, Greeting, LinkReport, Probe, Reading};

/// Without a STATE for this long there is no force, s.
pub(super) const STALE_SECONDS: f64 = 0.02;
/// A device that is silent for so long may have been reset, and waits for HELLO, s. Its answer to the last
/// one may alone take half of that, on the slowest line.
const RESET_SECONDS: f64 = 0.04;
/// Zero forces sent when parking: one may be lost on the wire.
const PARKING_FRAMES: u32 = 3;
const PARKING_PAUSE: std::time::Duration = std::time::Duration::from_millis(2);
/// Waits for a slow line to carry them, at most.
const PARKING_PAUSES: u32 = 50;
/// Reads in one tick at most, so that a flood of bytes cannot hold it up.
const READS_PER_TICK: usize = 16;

/// A device on a line that speaks the link.
pub struct LinkDevice<O: Opener> {
    pub(super) line: Line<O>,
    pub(super) next_hello: f64,
    pub(super) decoder: Decoder,
    pub(super) greeting: Option<Greeting>,
    pub(super) newest: Option<Newest>,
    /// Last sound STATE, or the greeting, s.
    pub(super) heard: f64,
    /// Out of sight for too long: any sequence number is taken next.
    pub(super) stale: bool,
    /// The probe was not seen since the session began: wherever it is then, it was set down there.
    pub(super) unseen: bool,
    /// The session before ended in this tick, so there is no force in it, whatever came since.
    pub(super) begun_anew: bool,
    pub(super) device_fault: bool,
    /// Zero forces still to be sent to a device whose session has ended.
    pub(super) farewells: u32,
    pub(super) speedometer: Speedometer,
    pub(super) orientations: Orientations,
    pub(super) arrivals: Arrivals,
    pub(super) pacing: Pacing,
    pub(super) freshness: Freshness,
    pub(super) doubt: Doubt,
    /// The one that is spoken, or tried.
    pub(super) protocol: u8,
    pub(super) sequence: u16,
    /// The last FORCE that was to be said had *enable*.
    pub(super) pushes: bool,
    /// The device shall brake.
    pub(super) brakes: bool,
    /// Since when the port takes no FORCE, s.
    pub(super) refused: Option<f64>,
    pub(super) now: f64,
    pub(super) dt: f64,
    pub(super) report: LinkReport,
}

impl<O: Opener> LinkDevice<O> {
    /// Opens the line; HELLO goes out with the first tick.
    ///
    /// # Errors
    /// When the line cannot be opened.
    pub fn open(opener: O) -> std::io::Result<Self> {
        Ok(Self {
            line: Line::open(opener)?,
            next_hello: 0.0,
            decoder: Decoder::default(),
            greeting: None,
            newest: None,
            heard: 0.0,
            stale: false,
            unseen: true,
            begun_anew: false,
            device_fault: false,
            farewells: 0,
            speedometer: Speedometer::default(),
            orientations: Orientations::default(),
            arrivals: Arrivals::default(),
            pacing: Pacing::default(),
            freshness: Freshness::default(),
            doubt: Doubt::default(),
            protocol: PROTOCOL,
            sequence: 0,
            pushes: false,
            brakes: false,
            refused: None,
            now: 0.0,
            dt: 0.0,
            report: LinkReport::default(),
        })
    }

    pub(super) fn is_greeted(&self) -> bool {
        self.greeting.is_some_and(|g| g.protocol == self.protocol)
    }

    /// What was said before is not waited for.
    fn excuse(&mut self) {
        self.freshness.forget();
        self.doubt.excuse();
    }

    /// Closes the line and forgets what was known of the device behind it.
    fn unplug(&mut self, now: f64) {
        self.line.close(now);
        self.greeting = None;
        self.farewells = 0;
        self.newest = None;
        self.stale = false;
        self.unseen = true;
        self.decoder.resynchronise();
        self.speedometer.reset();
        self.orientations.dismiss();
        self.orientations.forget();
        self.arrivals.forget();
        self.pacing = Pacing::default();
        self.freshness = Freshness::default();
        self.doubt = Doubt::default();
        self.protocol = PROTOCOL;
        self.refused = None;
    }

    /// Tries the port again now and then.
    fn reopen(&mut self, now: f64) {
        if self.line.reopen(now) {
            self.next_hello = now;
            self.report.reopened += 1;
        }
    }

    /// Takes all bytes that have come; the newest STATE stays.
    fn drain(&mut self, now: f64) {
        let mut buffer = [0; 256];
        for _ in 0..READS_PER_TICK {
            let Some(length) = self.line.read(&mut buffer) else {
                return self.unplug(now);
            };
            for &byte in &buffer[..length] {
                self.take(byte, now);
            }
            if length < buffer.len() {
                return;
            }
        }
    }
}

impl<O: Opener> Device for LinkDevice<O> {
    fn read(&mut self, now: f64, dt: f64, frame: &DeviceFrame) -> Reading {
        if now - self.now > STALE_SECONDS {
            // What the host did not look for is not late.
            self.excuse();
        }
        (self.now, self.dt) = (now, dt);
        if !self.line.is_open() {
            self.reopen(now);
        }
        if self.line.is_open() {
            self.drain(now);
            self.line.flush();
            self.line.repeat();
        }
        self.arrivals.end_of_tick(now);
        if !self.line.is_open() {
            return Reading::Fault(Fault::Unplugged);
        }
        let watch = self.live();
        if !self.is_greeted() {
            self.greet(now);
            return match self.greeting {
                Some(_) => Reading::Fault(Fault::Protocol),
                None => Reading::Waiting(reason::NO_ANSWER),
            };
        }
        let device_fault = std::mem::take(&mut self.device_fault);
        if let Some(fault) = Fault::of_watch(watch) {
            // What the device says of it is the same news.
            return Reading::Fault(fault);
        }
        if device_fault {
            return Reading::Fault(Fault::Device);
        }
        // It hears zero as long as it may hold a force of the session before: then the force ramps.
        if std::mem::take(&mut self.begun_anew) || self.farewells > 0 {
            return Reading::Waiting(reason::NO_STATE);
        }
        if now - self.heard > STALE_SECONDS {
            self.stale = true;
            self.speedometer.interrupt();
            self.orientations.interrupt();
            self.excuse();
            if now - self.heard > RESET_SECONDS {
                self.greet(now);
            }
            return Reading::Fault(Fault::Stale);
        }
        if self.is_deaf(now) {
            return Reading::Fault(Fault::Deaf);
        }
        let (Some(newest), Some(greeting)) = (&mut self.newest, self.greeting) else {
            return Reading::Waiting(reason::NO_STATE);
        };
        let Newest { state, speed, .. } = *newest;
        if state.fault {
            return Reading::Fault(Fault::Device);
        }
        if self.orientations.is_stale(now) {
            return Reading::Fault(Fault::Stale);
        }
        newest.is_told = true;
        let probe = Probe {
            position: frame.to_body(state.position()),
            orientation: frame.turn_to_body(self.orientations.rotation()),
            speed,
            restart: std::mem::take(&mut self.unseen),
            buttons: state.buttons,
            max_force: f64::from(greeting.max_force),
        };
        if state.ready {
            Reading::At(probe)
        } else {
            Reading::Passive(probe, reason::NOT_READY)
        }
    }

    fn write(&mut self, force: DVec3, enable: bool, frame: &DeviceFrame) {
        if !self.line.is_open() {
            return;
        }
        // Also a device that greets anew may still hold a force of the session before.
        if self.is_greeted() && self.farewells == 0 {
            self.say_force(frame.force_to_device(force), enable);
        } else {
            self.say_farewell();
        }
    }

    fn brake(&mut self, wanted: bool) {
        self.brakes = wanted;
    }

    fn park(&mut self) {
        for number in 0..PARKING_FRAMES {
            if self.line.is_open() && self.is_greeted() {
                self.say_zero(number > 0);
            }
            // Time for the device to read before the line closes.
            std::thread::sleep(PARKING_PAUSE);
            self.line.repeat();
        }
        for _ in 0..PARKING_PAUSES {
            self.line.flush();
            if self.line.queued() == 0 {
                break;
            }
            std::thread::sleep(PARKING_PAUSE);
        }
        let was_let_go = self.line.queued() == 0;
        self.line.end(was_let_go);
    }

    fn report(&self) -> LinkReport {
        LinkReport {
            crc_errors: self.decoder.errors.crc,
            cobs_errors: self.decoder.errors.cobs,
            oversize: self.decoder.errors.oversize,
            orientations: self.orientations.report.paired,
            orientations_unpaired: self.orientations.report.unpaired,
            orientations_refused: self.orientations.report.refused,
            orientations_lost: self.orientations.report.lost,
            arrivals: self.arrivals.report,
            round_trip: self.freshness.round_trip(),
            in_flight: self.freshness.in_flight() as u64,
            guarded: self.line.is_guarded(),
            state_age: self.newest.map(|_| self.now - self.heard),
            ..self.report
        }
    }
}
