//! The 2DIY as the servo sees it: asks with torques, is answered with angles, notices all that is odd.
//!
//! Every tick sends torques; each such request is answered with the angles of its moment. No answer
//! is waited for: what has come by the next tick counts. Boards have no watchdog, so a request with
//! no torque goes out whenever there is the least doubt.

use std::time::Duration;

use glam::{DMat3, DVec3};

use crate::device::haply::flight::Flight;
use crate::device::haply::inbox::Inbox;
use crate::device::haply::message::{
    ANSWER_BYTES, FILL, TORQUE_BYTES, parse_answer, setup_message, torque_message,
};
use crate::device::haply::model::{Model, TORQUE_LIMIT};
use crate::device::haply::pantograph::Pose;
use crate::device::haply::speed::WindowSpeed;
use crate::device::link::codec::Greeting;
use crate::device::reason;
use crate::device::serial::line::Line;
use crate::device::serial::port::Opener;
use crate::device::{Device, DeviceFrame, Fault, LinkReport, Probe, Reading};

/// A board is asked whether it knows this device this often, s.
const ASK_SECONDS: f64 = 0.05;
/// A board that answers with its address alone has said so by then, s.
const ANSWER_SECONDS: f64 = 0.01;
/// So often a board that knows this device may answer nonsense before it is set up anew.
const ASKED_IN_VAIN: u32 = 3;
/// So many answers of the address alone say that a board has no such device.
const LONE_ADDRESSES: usize = 3;
/// Boards lose a little memory with each setup: no oftener than this, s.
const SETUP_EVERY_SECONDS: f64 = 0.02;
/// Without an answer for this long there is no force, s.
const STALE_SECONDS: f64 = 0.02;
/// Angles older than this say nothing about where the handle is now, s.
const RESTORE_SECONDS: f64 = 0.05;
/// No hand turns an arm faster, degrees/s: at the handle some 3.5 m/s.
const FASTEST_TURN: f64 = 3000.0;
/// Answers that come together belong to different moments, degrees.
const JUMP_DEGREES: f64 = 2.0;
/// How far the arms may turn while they are set up anew, degrees.
const SETUP_DEGREES: f64 = 8.0;
/// Below this sine between the forearms the handle can hardly be held.
const LEAST_SINE: f64 = 0.1;
/// Requests without torque when parking: one may be lost on the wire.
const PARKING_REQUESTS: u32 = 3;
/// Reads in one tick at most, so that a flood of bytes cannot hold it up.
const READS_PER_TICK: usize = 16;
/// Completes whatever a board still waits for: the end of the longest message.
const FILL_BYTES: usize = 18;

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
    Asking { asked: Option<f64>, in_vain: u32 },
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

impl Phase {
    const BEGIN: Self = Self::Asking {
        asked: None,
        in_vain: 0,
    };
}

/// A 2DIY on a line.
pub struct HaplyDevice<O: Opener> {
    line: Line<O>,
    /// What has come and is no answer yet.
    inbox: Inbox,
    model: &'static Model,
    calibration: Calibration,
    /// The user has said where the handle rests; once, at the start.
    may_calibrate: bool,
    /// The angles count from a known pose.
    calibrated: bool,
    phase: Phase,
    /// Last angles taken or set, degrees.
    degrees: Option<[f64; 2]>,
    newest: Option<Newest>,
    heard: f64,
    set_up_at: f64,
    /// The board was set up and has not answered since.
    unproven: bool,
    now: f64,
    unseen: bool,
    speed: WindowSpeed,
    flight: Flight,
    limp: bool,
    report: LinkReport,
}

impl<O: Opener> HaplyDevice<O> {
    /// Opens the line; the board is asked with the first tick.
    ///
    /// # Errors
    /// When the line cannot be opened.
    pub fn open(
        opener: O,
        model: &'static Model,
        calibration: Calibration,
    ) -> std::io::Result<Self> {
        Ok(Self {
            line: Line::open(opener)?,
            inbox: Inbox::EMPTY,
            model,
            calibration,
            may_calibrate: true,
            calibrated: false,
            phase: Phase::BEGIN,
            degrees: None,
            newest: None,
            heard: 0.0,
            set_up_at: f64::NEG_INFINITY,
            unproven: false,
            now: 0.0,
            unseen: true,
            speed: WindowSpeed::default(),
            flight: Flight::default(),
            limp: false,
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
        self.line.close(self.now);
        self.inbox.clear();
        self.phase = Phase::BEGIN;
        self.calibrated = false;
        self.degrees = None;
        self.newest = None;
        self.unseen = true;
        self.unproven = false;
        self.speed.reset();
        self.flight = Flight::default();
    }

    fn drain(&mut self) {
        let mut buffer = [0; 256];
        for _ in 0..READS_PER_TICK {
            let Some(length) = self.line.read(&mut buffer) else {
                return self.unplug();
            };
            // What came before the first question is left over from somebody else.
            let fresh = if self.phase == Phase::BEGIN {
                0
            } else {
                length
            };
            for &byte in &buffer[..fresh] {
                if let Some(answer) = self.inbox.push(byte) {
                    self.take_answer(&answer);
                }
            }
            if length < buffer.len() {
                return;
            }
        }
    }

    /// Takes nine bytes for an answer, or the first of them for damage.
    fn take_answer(&mut self, answer: &[u8; ANSWER_BYTES]) {
        let answer = parse_answer(self.model, self.address(), answer);
        let Some(degrees) = answer.filter(|degrees| self.is_near(*degrees)) else {
            self.inbox.drop_first(1);
            self.report.crc_errors += 1;
            let running = self.calibrated && self.phase == Phase::Running;
            if running && self.now - self.heard > RESTORE_SECONDS {
                // It answers, but with other angles than it was set up with, or counts otherwise.
                self.calibrated = false;
                self.restore();
            }
            return;
        };
        self.inbox.drop_first(ANSWER_BYTES);
        self.accept(degrees);
    }

    /// Whether the arms can have turned to `degrees` since they were last seen.
    fn is_near(&self, degrees: [f64; 2]) -> bool {
        let farthest = if self.unproven {
            SETUP_DEGREES
        } else {
            JUMP_DEGREES + FASTEST_TURN * (self.now - self.heard)
        };
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
        self.unproven = false;
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
            speed: self.speed.speed(position, self.now),
        });
    }

    /// Sets up a board that has forgotten its device, by the angles of a moment ago if there are any.
    fn restore(&mut self) {
        self.inbox.clear();
        self.calibrated &= self.now - self.heard < RESTORE_SECONDS;
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
        self.phase = Phase::Running;
        let message = setup_message(self.model, self.address(), degrees);
        if self.line.send(&message) {
            self.may_calibrate = false;
            self.set_up_at = self.now;
            self.degrees = Some(degrees.map(f64::from));
            self.newest = None;
            self.unproven = true;
            self.heard = self.now;
            self.flight = Flight::default();
            if self.calibrated {
                self.report.greeting = Some(greeting(self.model));
            }
        } else {
            self.calibrated = false;
            self.phase = Phase::BEGIN;
        }
    }

    /// Finds out whether the board knows this device, and sets it up if not.
    fn ask(&mut self, asked: Option<f64>, in_vain: u32) {
        let waited = asked.map_or(f64::INFINITY, |then| self.now - then);
        let address = self.model.address;
        let inbox = self.inbox.bytes();
        let heard = inbox.first() == Some(&address);
        // The address alone: not this device. More than that, but no angles: set up by mistake.
        let alone = inbox.iter().all(|byte| *byte == address);
        let knows_nothing = heard && (alone || in_vain >= ASKED_IN_VAIN);
        if waited >= ANSWER_SECONDS && knows_nothing {
            self.inbox.clear();
            return self.set_up(self.may_calibrate);
        }
        if waited < ASK_SECONDS {
            return;
        }
        let in_vain = if heard { in_vain + 1 } else { 0 };
        self.inbox.clear();
        self.flight = Flight::default();
        let request = torque_message(self.model, self.model.address, [0.0; 2]);
        let mut message = [FILL; FILL_BYTES + TORQUE_BYTES];
        message[FILL_BYTES..].copy_from_slice(&request);
        self.report.hellos += u64::from(self.line.send(&message));
        self.phase = Phase::Asking {
            asked: Some(self.now),
            in_vain,
        };
    }

    fn request(&mut self, torques: Option<[f64; 2]>) {
        let limp = torques.is_none();
        // Behind requests that wait already a new one would only queue; letting go comes first.
        if self.flight.is_full() && (!limp || self.limp) {
            self.report.unsent += 1;
            return;
        }
        let message = torque_message(self.model, self.address(), torques.unwrap_or_default());
        if self.line.send(&message) {
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
        if !self.line.is_open() {
            self.report.reopened += u64::from(self.line.reopen(now));
        }
        if self.line.is_open() {
            self.drain();
        }
        self.report.lost += self.flight.expire(now);
        if !self.line.is_open() {
            return Reading::Fault(Fault::Unplugged);
        }
        if let Phase::Asking { asked, in_vain } = self.phase {
            self.ask(asked, in_vain);
            return Reading::Waiting(reason::NO_BOARD);
        }
        let (address, inbox) = (self.address(), self.inbox.bytes());
        if inbox.len() >= LONE_ADDRESSES && inbox.iter().all(|byte| *byte == address) {
            self.report.unknown += 1;
            self.restore();
        }
        if !self.calibrated {
            return Reading::Waiting(reason::LOST_PLACE);
        }
        if now - self.heard > STALE_SECONDS {
            return Reading::Fault(Fault::Stale);
        }
        let Some(newest) = self.newest else {
            let settled = !self.unproven;
            return Reading::Waiting(if settled {
                reason::NO_ANGLES
            } else {
                reason::SETTING_UP
            });
        };
        let Some(pose) = newest.pose else {
            return Reading::Fault(Fault::Device);
        };
        let stretched = pose.sine < LEAST_SINE;
        let probe = Probe {
            position: frame.to_body(newest.position),
            orientation: frame.turn_to_body(DMat3::IDENTITY),
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
        if !self.line.is_open() || self.phase != Phase::Running {
            return;
        }
        let torques = self.torques(frame.force_to_device(force));
        self.request(torques.filter(|_| enable));
    }

    fn park(&mut self) {
        for _ in 0..PARKING_REQUESTS {
            self.flight = Flight::default();
            if self.line.is_open() {
                self.request(None);
            }
            // Time for the board to read before the line closes.
            std::thread::sleep(Duration::from_millis(2));
        }
        self.line.flush();
        self.line.close(self.now);
    }

    fn report(&self) -> LinkReport {
        self.report
    }
}

impl<O: Opener> Drop for HaplyDevice<O> {
    /// Boards keep their torque for ever; whoever drops this without parking leaves none.
    fn drop(&mut self) {
        if self.line.is_open() {
            self.flight = Flight::default();
            self.request(None);
        }
    }
}
