//! The serial device: link of version 1 as the host speaks it, with all that goes wrong on a wire.

pub mod codec;
mod orientation;

use glam::DVec3;

use crate::device::arrival::Arrivals;
use crate::device::link::codec::{
    Decoder, DeviceState, Greeting, MAX_FRAME, Message, PROTOCOL, force_payload, hello_payload,
};
use crate::device::link::orientation::Turning;
use crate::device::reason;
use crate::device::serial::line::Line;
use crate::device::serial::port::Opener;
use crate::device::speedometer::{Speedometer, has_begun_anew};
use crate::device::{Device, DeviceFrame, Fault, LinkReport, Probe, Reading};

/// HELLO is repeated this often until it is answered, s.
const HELLO_SECONDS: f64 = 0.05;
/// Without a STATE for this long there is no force, s.
const STALE_SECONDS: f64 = 0.02;
/// Zero forces sent when parking: one may be lost on the wire.
const PARKING_FRAMES: u32 = 3;
/// Reads in one tick at most, so that a flood of bytes cannot hold it up.
const READS_PER_TICK: usize = 16;

/// The newest STATE and when it came.
#[derive(Debug, Clone, Copy)]
struct Newest {
    state: DeviceState,
    speed: f64,
}

/// A device on a line that speaks the link.
pub struct LinkDevice<O: Opener> {
    line: Line<O>,
    next_hello: f64,
    decoder: Decoder,
    greeting: Option<Greeting>,
    newest: Option<Newest>,
    /// Last sound STATE, or the greeting, s.
    heard: f64,
    /// Out of sight for too long: any sequence number is taken next.
    stale: bool,
    /// The probe was not seen since the session began: wherever it is then, it was set down there.
    unseen: bool,
    /// The session before ended in this tick, so there is no force in it, whatever came since.
    begun_anew: bool,
    device_fault: bool,
    speedometer: Speedometer,
    turning: Turning,
    arrivals: Arrivals,
    sequence: u16,
    report: LinkReport,
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
            speedometer: Speedometer::default(),
            turning: Turning::default(),
            arrivals: Arrivals::default(),
            sequence: 0,
            report: LinkReport::default(),
        })
    }

    fn is_greeted(&self) -> bool {
        self.greeting.is_some_and(|g| g.protocol == PROTOCOL)
    }

    /// Closes the line and forgets what was known of the device behind it.
    fn unplug(&mut self, now: f64) {
        self.line.close(now);
        self.greeting = None;
        self.newest = None;
        self.stale = false;
        self.unseen = true;
        self.decoder.resynchronise();
        self.speedometer.reset();
        self.turning.dismiss();
        self.turning.forget();
        self.arrivals.forget();
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

    fn take(&mut self, byte: u8, now: f64) {
        let Some(payload) = self.decoder.push(byte) else {
            return;
        };
        match codec::parse(payload) {
            Some(Message::Hello(greeting)) if !greeting.is_sound() => {
                self.greeting = None;
                self.report.unknown += 1;
            }
            Some(Message::Hello(greeting)) => {
                // One that says the same was only asked twice; another figure is another device.
                if self.greeting != Some(greeting) {
                    self.turning.dismiss();
                    self.begin_session(now);
                }
                self.greeting = Some(greeting);
                self.report.greeting = Some(greeting);
            }
            // A device that streams before it was greeted may speak another version.
            Some(Message::State(state)) if self.is_greeted() => self.take_state(state, now),
            Some(Message::Orientation(orientation)) if self.is_greeted() => {
                self.turning.tell(orientation);
            }
            Some(Message::State(_) | Message::Orientation(_)) => {}
            Some(Message::Fault { code, detail }) => {
                self.device_fault = true;
                self.report.device_faults += 1;
                self.report.last_fault = Some((code, detail));
            }
            None => self.report.unknown += 1,
        }
    }

    /// Forgets where the device was before, and its sequence.
    fn begin_session(&mut self, now: f64) {
        self.heard = now;
        self.begun_anew |= self.newest.take().is_some();
        self.stale = false;
        self.unseen = true;
        self.device_fault = false;
        self.speedometer.reset();
        self.turning.forget();
    }

    fn take_state(&mut self, state: DeviceState, now: f64) {
        if let Some(last) = &self.newest
            && self.stale
            && has_begun_anew(last.state.time_us, state.time_us, now - self.heard)
        {
            self.begin_session(now);
        }
        if let Some(last) = &self.newest
            && !self.stale
        {
            match state.sequence.wrapping_sub(last.state.sequence) {
                0 => {
                    self.report.duplicates += 1;
                    return self.turning.dismiss();
                }
                ahead @ 1..=0x7FFF => self.report.lost += u64::from(ahead) - 1,
                _ => {
                    self.report.out_of_order += 1;
                    return self.turning.dismiss();
                }
            }
        }
        self.report.states += 1;
        self.arrivals.take(state.time_us);
        let speed = self.speedometer.speed(state.position(), state.time_us, now);
        let was_turned = self.turning.is_known();
        let swing = self.turning.pair(state.sequence, state.time_us, now);
        if !was_turned && self.turning.is_known() {
            // Until now it was taken for upright: no sweep leads from there to how it is turned.
            self.begun_anew |= self.newest.is_some();
            self.unseen = true;
        }
        let speed = speed.max(swing);
        self.newest = Some(Newest { state, speed });
        self.heard = now;
        self.stale = false;
    }

    /// Puts a frame on the line; false when it does not fit or the line is gone.
    fn send(&mut self, payload: &[u8]) -> bool {
        let mut frame = [0; MAX_FRAME];
        codec::encode(payload, &mut frame).is_some_and(|length| self.line.send(&frame[..length]))
    }

    fn greet(&mut self, now: f64) {
        if now >= self.next_hello {
            self.next_hello = now + HELLO_SECONDS;
            self.report.hellos += u64::from(self.send(&hello_payload()));
        }
    }
}

impl<O: Opener> Device for LinkDevice<O> {
    fn read(&mut self, now: f64, _dt: f64, frame: &DeviceFrame) -> Reading {
        if !self.line.is_open() {
            self.reopen(now);
        }
        if self.line.is_open() {
            self.drain(now);
        }
        self.arrivals.end_of_tick(now);
        if !self.line.is_open() {
            return Reading::Fault(Fault::Unplugged);
        }
        if !self.is_greeted() {
            self.greet(now);
            return match self.greeting {
                Some(_) => Reading::Fault(Fault::Protocol),
                None => Reading::Waiting(reason::NO_ANSWER),
            };
        }
        if std::mem::take(&mut self.device_fault) {
            return Reading::Fault(Fault::Device);
        }
        if std::mem::take(&mut self.begun_anew) {
            return Reading::Waiting(reason::NO_STATE);
        }
        if now - self.heard > STALE_SECONDS {
            self.stale = true;
            self.speedometer.reset();
            self.turning.interrupt();
            // A device that was reset waits for HELLO.
            self.greet(now);
            return Reading::Fault(Fault::Stale);
        }
        let (Some(Newest { state, speed }), Some(greeting)) = (self.newest, self.greeting) else {
            return Reading::Waiting(reason::NO_STATE);
        };
        if state.fault {
            return Reading::Fault(Fault::Device);
        }
        if self.turning.is_stale(now) {
            return Reading::Fault(Fault::Stale);
        }
        let probe = Probe {
            position: frame.to_body(state.position()),
            orientation: frame.turn_to_body(self.turning.rotation()),
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
        if !self.line.is_open() || !self.is_greeted() {
            return;
        }
        let payload = force_payload(self.sequence, frame.force_to_device(force), enable);
        if self.send(&payload) {
            self.sequence = self.sequence.wrapping_add(1);
            self.report.forces += 1;
        } else {
            self.report.unsent += 1;
        }
    }

    fn park(&mut self) {
        for _ in 0..PARKING_FRAMES {
            self.write(DVec3::ZERO, false, &DeviceFrame::default());
            // Time for the device to read before the line closes.
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        self.line.flush();
        self.line.close(0.0);
    }

    fn report(&self) -> LinkReport {
        LinkReport {
            crc_errors: self.decoder.errors.crc,
            cobs_errors: self.decoder.errors.cobs,
            oversize: self.decoder.errors.oversize,
            orientations: self.turning.report.paired,
            orientations_unpaired: self.turning.report.unpaired,
            orientations_refused: self.turning.report.refused,
            orientations_lost: self.turning.report.lost,
            rhythm: self.arrivals.rhythm,
            ..self.report
        }
    }
}
