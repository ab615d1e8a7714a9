//! The 2DIY as the servo sees it: asks with torques, is answered with angles, notices all that is odd.
//!
//! Every tick sends torques; each such request is answered with the angles of its moment. No answer
//! is waited for: what has come by the next tick counts. Boards have no watchdog, so a request with
//! no torque goes out whenever there is the least doubt.

use std::io::ErrorKind;
use std::time::Duration;

use glam::DVec3;

use super::flight::Flight;
use super::message::{
    ANSWER_BYTES, FILL, SETUP_BYTES, TORQUE_BYTES, parse_answer, setup_message, torque_message,
};
use super::model::{Model, TORQUE_LIMIT};
use super::pantograph::Pose;
use crate::codec::Greeting;
use crate::device::{Device, DeviceFrame, Fault, LinkReport, Probe, Reading};
use crate::port::{Opener, Wire};
use crate::state::reason;

/// A board is asked whether it knows this device this often, s.
const ASK_SECONDS: f64 = 0.05;
/// A board that answers with its address alone has said so by then, s.
const ANSWER_SECONDS: f64 = 0.01;
/// What a board needs to set itself up, s; it is not spoken to meanwhile.
const SETTLE_SECONDS: f64 = 0.005;
/// Boards lose a little memory with each setup: no oftener than this, s.
const SETUP_EVERY_SECONDS: f64 = 0.1;
/// Without an answer for this long there is no force, s.
const STALE_SECONDS: f64 = 0.02;
/// Angles older than this say nothing about where the handle is now, s.
const RESTORE_SECONDS: f64 = 0.05;
/// A port that is gone is tried again this often, s.
const REOPEN_SECONDS: f64 = 0.2;
/// No hand turns an arm faster, degrees/s: at the handle some 7 m/s.
const FASTEST_TURN: f64 = 6000.0;
/// Answers that come together belong to different moments, degrees.
const JUMP_DEGREES: f64 = 8.0;
/// Speeds are measured over at least this time, s: a count is a third of a millimetre.
const SPEED_SECONDS: f64 = 0.005;
/// Below this sine between the forearms the handle can hardly be held.
const LEAST_SINE: f64 = 0.1;
/// Requests without torque when parking: one may be lost on the wire.
const PARKING_REQUESTS: u32 = 3;
const READS_PER_TICK: usize = 16;
/// Completes whatever a board still waits for: the end of the longest message.
const FILL_BYTES: usize = 18;
const OUTBOX: usize = 64;

/// How the angles get their zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    /// Angles at the start, degrees (arm 1, arm 2).
    pub degrees: [f32; 2],
    /// Even when the board still knows its angles from an earlier start.
    pub always: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// Whether the board knows this device; last asked then, if at all.
    Asking { asked: Option<f64> },
    /// It is told what it has on which port since then.
    SettingUp { since: f64 },
    /// Requests and answers.
    Running,
}

#[derive(Debug, Clone, Copy)]
struct Newest {
    position: DVec3,
    /// None where the arms cannot be.
    pose: Option<Pose>,
    speed: f64,
}

/// Bytes that arrived and are no answer yet.
#[derive(Debug, Clone, Copy)]
struct Inbox {
    bytes: [u8; 64],
    length: usize,
}

impl Inbox {
    const EMPTY: Self = Self {
        bytes: [0; 64],
        length: 0,
    };

    /// Takes a byte; true when there are enough for an answer.
    fn push(&mut self, byte: u8) -> bool {
        self.bytes[self.length] = byte;
        self.length += 1;
        self.length >= ANSWER_BYTES
    }

    fn answer(&self) -> &[u8; ANSWER_BYTES] {
        self.bytes.first_chunk().expect("the inbox is longer")
    }

    fn drop_first(&mut self, count: usize) {
        self.bytes.copy_within(count..self.length, 0);
        self.length -= count;
    }
}

/// A 2DIY on a line.
pub struct HaplyDevice<O: Opener> {
    opener: O,
    wire: Option<O::Wire>,
    retry_at: f64,
    model: &'static Model,
    calibration: Calibration,
    /// The user has said where the handle rests; once, at the start.
    may_calibrate: bool,
    /// The angles count from a known pose.
    calibrated: bool,
    phase: Phase,
    inbox: Inbox,
    /// Last angles taken or set, degrees.
    degrees: Option<[f64; 2]>,
    newest: Option<Newest>,
    heard: f64,
    set_up_at: f64,
    now: f64,
    unseen: bool,
    since_speed: [(f64, DVec3); 2],
    flight: Flight,
    limp: bool,
    pending: [u8; OUTBOX],
    pending_from: usize,
    pending_to: usize,
    report: LinkReport,
}

impl<O: Opener> HaplyDevice<O> {
    /// Opens the line; the board is asked with the first tick.
    ///
    /// # Errors
    /// When the line cannot be opened.
    pub fn open(
        mut opener: O,
        model: &'static Model,
        calibration: Calibration,
    ) -> std::io::Result<Self> {
        let wire = opener.open()?;
        Ok(Self {
            opener,
            wire: Some(wire),
            retry_at: 0.0,
            model,
            calibration,
            may_calibrate: true,
            calibrated: false,
            phase: Phase::Asking { asked: None },
            inbox: Inbox::EMPTY,
            degrees: None,
            newest: None,
            heard: 0.0,
            set_up_at: f64::NEG_INFINITY,
            now: 0.0,
            unseen: true,
            since_speed: [(0.0, DVec3::ZERO); 2],
            flight: Flight::default(),
            limp: false,
            pending: [0; OUTBOX],
            pending_from: 0,
            pending_to: 0,
            report: LinkReport::default(),
        })
    }

    fn address(&self) -> u8 {
        if matches!(self.phase, Phase::Asking { .. }) || self.calibrated {
            self.model.address
        } else {
            self.model.adrift_address()
        }
    }

    fn unplug(&mut self) {
        self.wire = None;
        self.retry_at = self.now + REOPEN_SECONDS;
        self.phase = Phase::Asking { asked: None };
        self.calibrated = false;
        self.degrees = None;
        self.newest = None;
        self.unseen = true;
        self.inbox = Inbox::EMPTY;
        self.flight = Flight::default();
        (self.pending_from, self.pending_to) = (0, 0);
    }

    /// Tries the port again now and then. Opening takes time and memory: nothing is in contact.
    fn reopen(&mut self) {
        if self.now < self.retry_at {
            return;
        }
        match self.opener.open() {
            Ok(wire) => {
                self.wire = Some(wire);
                self.report.reopened += 1;
            }
            Err(_) => self.retry_at = self.now + REOPEN_SECONDS,
        }
    }

    fn drain(&mut self) {
        let mut buffer = [0; 256];
        for _ in 0..READS_PER_TICK {
            let Some(wire) = &mut self.wire else { return };
            match wire.read(&mut buffer) {
                Ok(0) => return self.unplug(),
                Ok(length) => {
                    for &byte in &buffer[..length] {
                        if self.inbox.push(byte) {
                            self.take_answer();
                        }
                    }
                    if length < buffer.len() {
                        return;
                    }
                }
                Err(e) if e.kind() == ErrorKind::WouldBlock => return,
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(_) => return self.unplug(),
            }
        }
    }

    /// Takes nine bytes for an answer, or the first of them for damage.
    fn take_answer(&mut self) {
        let address = self.address();
        let answer = *self.inbox.answer();
        match parse_answer(self.model, address, &answer) {
            Some(degrees) if self.is_near(degrees) => {
                self.inbox.drop_first(ANSWER_BYTES);
                self.accept(degrees);
            }
            _ if answer == [address; ANSWER_BYTES] => {
                // A board without this device answers with the address alone.
                self.inbox = Inbox::EMPTY;
                self.report.unknown += 1;
                self.restore();
            }
            _ => {
                self.inbox.drop_first(1);
                self.report.crc_errors += 1;
            }
        }
    }

    fn is_near(&self, degrees: [f64; 2]) -> bool {
        let farthest = JUMP_DEGREES + FASTEST_TURN * (self.now - self.heard);
        self.degrees.is_none_or(|last| {
            let [first, second] = [0, 1].map(|arm| (degrees[arm] - last[arm]).abs());
            first.max(second) <= farthest
        })
    }

    fn accept(&mut self, degrees: [f64; 2]) {
        self.report.states += 1;
        self.flight.answer();
        self.heard = self.now;
        self.degrees = Some(degrees);
        if matches!(self.phase, Phase::Asking { .. }) {
            self.calibrated = !self.calibration.always || !self.may_calibrate;
            if !self.calibrated {
                return self.set_up(true);
            }
            self.phase = Phase::Running;
            self.may_calibrate = false;
            self.report.greeting = Some(greeting(self.model));
        }
        let pose = self.model.pantograph.pose(degrees.map(f64::to_radians));
        let last = self.newest.map_or(DVec3::ZERO, |newest| newest.position);
        let position = pose.map_or(last, |pose| self.model.to_device(pose.position));
        self.newest = Some(Newest {
            position,
            pose,
            speed: self.speed(position),
        });
    }

    /// Speed over the last five to ten milliseconds, m/s.
    fn speed(&mut self, position: DVec3) -> f64 {
        if self.unseen && self.newest.is_none() {
            self.since_speed = [(self.now, position); 2];
        }
        let [_, recent] = self.since_speed;
        if self.now - recent.0 >= SPEED_SECONDS {
            self.since_speed = [recent, (self.now, position)];
        }
        let [(then, from), _] = self.since_speed;
        if position == from {
            return 0.0;
        }
        position.distance(from) / (self.now - then).max(SPEED_SECONDS)
    }

    /// Sets up a board that has forgotten its device, by the angles of a moment ago if there are any.
    fn restore(&mut self) {
        let fresh = self.calibrated && self.now - self.heard < RESTORE_SECONDS;
        self.calibrated = fresh;
        self.set_up(false);
    }

    /// Tells the board what it has on its ports; with `anew`, the handle rests where the user said.
    /// Without a known pose the board is set up too, or its motors would keep what they last had.
    fn set_up(&mut self, anew: bool) {
        if self.now - self.set_up_at < SETUP_EVERY_SECONDS {
            return;
        }
        let degrees = match self.degrees {
            _ if anew => self.calibration.degrees,
            Some(last) if self.calibrated => last.map(|degrees| degrees as f32),
            _ => self.model.rest_degrees(),
        };
        self.calibrated |= anew;
        self.phase = Phase::SettingUp { since: self.now };
        let message = setup_message(self.model, self.address(), degrees);
        if self.send::<SETUP_BYTES>(&message) {
            self.may_calibrate = false;
            self.set_up_at = self.now;
            self.degrees = Some(degrees.map(f64::from));
            self.flight = Flight::default();
            if self.calibrated {
                self.report.greeting = Some(greeting(self.model));
            }
        } else {
            self.calibrated = false;
            self.phase = Phase::Asking { asked: None };
        }
    }

    /// Finds out whether the board knows this device, and sets it up if not.
    fn ask(&mut self, asked: Option<f64>) {
        let waited = asked.map_or(f64::INFINITY, |then| self.now - then);
        let knows_nothing = self.inbox.length == 1 && self.inbox.bytes[0] == self.model.address;
        if waited >= ANSWER_SECONDS && knows_nothing {
            self.inbox = Inbox::EMPTY;
            return self.set_up(self.may_calibrate);
        }
        if waited < ASK_SECONDS {
            return;
        }
        self.inbox = Inbox::EMPTY;
        self.flight = Flight::default();
        let request = torque_message(self.model, self.model.address, [0.0; 2]);
        let mut message = [FILL; FILL_BYTES + TORQUE_BYTES];
        message[FILL_BYTES..].copy_from_slice(&request);
        self.report.hellos += u64::from(self.send(&message));
        self.phase = Phase::Asking {
            asked: Some(self.now),
        };
    }

    /// Puts a message on the line; false when it does not fit or the line is gone.
    fn send<const N: usize>(&mut self, message: &[u8; N]) -> bool {
        self.flush();
        if self.wire.is_none() || self.pending_from < self.pending_to {
            return false;
        }
        self.pending[..N].copy_from_slice(message);
        (self.pending_from, self.pending_to) = (0, N);
        self.flush();
        if self.pending_from == 0 && self.pending_to > 0 {
            // Not begun: better a newer message later than this one.
            self.pending_to = 0;
            return false;
        }
        true
    }

    fn flush(&mut self) {
        while self.pending_from < self.pending_to {
            let Some(wire) = &mut self.wire else { return };
            match wire.write(&self.pending[self.pending_from..self.pending_to]) {
                Ok(written) if written > 0 => self.pending_from += written,
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                // A line that is gone is found by the next read.
                _ => return,
            }
        }
        (self.pending_from, self.pending_to) = (0, 0);
    }

    fn request(&mut self, torques: Option<[f64; 2]>) {
        let limp = torques.is_none();
        // Behind requests that wait already a new one would only queue; letting go comes first.
        if self.flight.is_full() && (!limp || self.limp) {
            self.report.unsent += 1;
            return;
        }
        let message = torque_message(self.model, self.address(), torques.unwrap_or_default());
        if self.send(&message) {
            self.flight.send(self.now);
            self.limp = limp;
            self.report.forces += 1;
        } else {
            self.report.unsent += 1;
        }
    }

    fn torques(&self, force: DVec3) -> Option<[f64; 2]> {
        let fresh = self.calibrated && self.now - self.heard <= STALE_SECONDS;
        let pose = self.newest.filter(|_| fresh)?.pose?;
        if pose.sine < LEAST_SINE {
            return None;
        }
        let [first, second] = pose.torques(self.model.to_pantograph(force));
        let most = first.abs().max(second.abs());
        // Both are shortened alike, or the force would turn.
        let share = (TORQUE_LIMIT / most).min(1.0);
        (most > 0.0 && most.is_finite()).then_some([first * share, second * share])
    }
}

/// What the device would say of itself, if it could.
fn greeting(model: &Model) -> Greeting {
    let mut name = [0; 16];
    name[..model.name.len()].copy_from_slice(model.name.as_bytes());
    let middle = model.largest_force_in_the_middle();
    let [x, y] = model.half_extents.to_array();
    Greeting {
        protocol: 0,
        name,
        axes: 2,
        max_force: middle as f32,
        half_extents: [x as f32, y as f32, 0.0],
        rate_hz: 0,
    }
}

impl<O: Opener> Device for HaplyDevice<O> {
    fn read(&mut self, now: f64, _dt: f64, frame: &DeviceFrame) -> Reading {
        self.now = now;
        if self.wire.is_none() {
            self.reopen();
        }
        self.drain();
        self.report.lost += self.flight.expire(now);
        if self.wire.is_none() {
            return Reading::Fault(Fault::Unplugged);
        }
        match self.phase {
            Phase::Asking { asked } => {
                self.ask(asked);
                return Reading::Waiting(reason::NO_BOARD);
            }
            Phase::SettingUp { since } if now - since < SETTLE_SECONDS => {
                return Reading::Waiting(reason::SETTING_UP);
            }
            Phase::SettingUp { .. } => {
                self.phase = Phase::Running;
                self.heard = now;
            }
            Phase::Running => {}
        }
        if !self.calibrated {
            return Reading::Waiting(reason::LOST_PLACE);
        }
        if now - self.heard > STALE_SECONDS {
            return Reading::Fault(Fault::Stale);
        }
        let Some(newest) = self.newest else {
            return Reading::Waiting(reason::NO_ANGLES);
        };
        let Some(pose) = newest.pose else {
            return Reading::Fault(Fault::Device);
        };
        let stretched = pose.sine < LEAST_SINE;
        let probe = Probe {
            position: frame.to_body(newest.position),
            speed: newest.speed,
            restart: std::mem::take(&mut self.unseen),
            buttons: 0,
            max_force: pose.largest_force(TORQUE_LIMIT),
        };
        if stretched {
            Reading::Passive(probe, reason::STRETCHED)
        } else {
            Reading::At(probe)
        }
    }

    fn write(&mut self, force: DVec3, enable: bool, frame: &DeviceFrame) {
        if self.wire.is_none() || self.phase != Phase::Running {
            return;
        }
        let torques = self.torques(frame.force_to_device(force));
        self.request(torques.filter(|_| enable));
    }

    fn park(&mut self) {
        for _ in 0..PARKING_REQUESTS {
            self.flight = Flight::default();
            if self.wire.is_some() {
                self.request(None);
            }
            // Time for the board to read before the line closes.
            std::thread::sleep(Duration::from_millis(2));
        }
        self.flush();
        self.wire = None;
    }

    fn report(&self) -> LinkReport {
        self.report
    }
}

impl<O: Opener> Drop for HaplyDevice<O> {
    /// Boards keep their torque for ever; whoever drops this without parking leaves none.
    fn drop(&mut self) {
        if self.wire.is_some() {
            self.flight = Flight::default();
            self.request(None);
        }
    }
}
