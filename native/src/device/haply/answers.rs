//! Answers of the board: which to believe, and when to ask or set it up anew.

use glam::DVec3;

use crate::device::Greeting;
use crate::device::haply::device::{HaplyDevice, Phase};
use crate::device::haply::flight::Flight;
use crate::device::haply::message::{
    ANSWER_BYTES, FILL, TORQUE_BYTES, parse_answer, setup_message, torque_message,
};
use crate::device::haply::model::Model;
use crate::device::haply::newest::Newest;
use crate::device::haply::pantograph::Pose;
use crate::device::serial::wire::Opener;
use crate::guardian::Watch;

/// A board is asked whether it knows this device this often, s.
const ASK_SECONDS: f64 = 0.05;
/// A board that answers with its address alone has said so by then, s.
const ANSWER_SECONDS: f64 = 0.01;
/// Unsound answers of a board that knows this device before it is set up anew.
const ASKED_IN_VAIN: u32 = 3;
/// Boards lose a little memory with each setup: no oftener than this, s.
const SETUP_EVERY_SECONDS: f64 = 0.02;
/// Angles older than this say nothing about where the handle is now, s.
const RESTORE_SECONDS: f64 = 0.05;
/// No hand turns an arm faster, degrees/s: at the handle some 3.5 m/s.
const FASTEST_TURN: f64 = 3000.0;
/// Answers that come together belong to different moments, degrees.
const JUMP_DEGREES: f64 = 2.0;
/// Largest turn of the arms while they are set up anew, degrees.
const SETUP_DEGREES: f64 = 8.0;
/// Completes whatever a board still waits for: the end of the longest message.
const FILL_BYTES: usize = 18;

impl<O: Opener> HaplyDevice<O> {
    /// Takes nine bytes for an answer, or the first of them for damage.
    pub(super) fn take_answer(&mut self, answer: &[u8; ANSWER_BYTES]) {
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
            JUMP_DEGREES + FASTEST_TURN * self.speed.since(&self.flight.moment(self.now))
        };
        self.degrees.is_none_or(|last| {
            let [first, second] = [0, 1].map(|arm| (degrees[arm] - last[arm]).abs());
            first.max(second) <= farthest
        })
    }

    fn accept(&mut self, degrees: [f64; 2]) {
        self.report.states += 1;
        let moment = self.flight.moment(self.now);
        self.flight.answer(self.now);
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
        let step = self.speed.step(position, moment);
        self.unseen |= step.has_strayed;
        let newest = Newest {
            position,
            pose,
            speed: step.speed,
            is_impossible: pose.is_none(),
            is_stretched: pose.as_ref().is_some_and(Pose::is_stretched),
            came: self.now,
            is_told: false,
        };
        self.newest = Some(self.newest.map_or(newest, |before| newest.after(&before)));
    }

    /// Sets up a board that has forgotten its device, by the angles of a moment ago if there are any.
    pub(super) fn restore(&mut self) {
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

    /// Completes whatever the board still waits for, and asks for no torque.
    fn limp_request(&self, address: u8) -> [u8; FILL_BYTES + TORQUE_BYTES] {
        let mut message = [FILL; FILL_BYTES + TORQUE_BYTES];
        let request = torque_message(self.model, address, [0.0; 2]);
        message[FILL_BYTES..].copy_from_slice(&request);
        message
    }

    /// Tells that the servo lives, and what lets the board go should it end.
    pub(super) fn live(&mut self) -> Watch {
        let message = self.limp_request(self.address());
        let is_known = self.phase != Phase::BEGIN;
        let watch = self.line.live(if is_known { &message } else { &[] });
        if watch == Watch::Spoke {
            self.inbox.clear();
            self.flight = Flight::default();
        }
        watch
    }

    /// Finds out whether the board knows this device, and sets it up if not.
    pub(super) fn ask(&mut self, asked: Option<f64>, in_vain: u32) {
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
        let message = self.limp_request(self.model.address);
        self.report.hellos += u64::from(self.line.send(&message));
        self.phase = Phase::Asking {
            asked: Some(self.now),
            in_vain,
        };
    }
}

/// Greeting that the device would send if its protocol had one.
fn greeting(model: &Model) -> Greeting {
    let mut name = [0; 16];
    name[..model.name.len()].copy_from_slice(model.name.as_bytes());
    let middle = model.largest_force_in_the_middle();
    let [x, y] = model.half_extents.to_array();
    Greeting {
        largest_damping: 0.0,
        protocol: 0,
        name,
        axes: 2,
        max_force: middle as f32,
        half_extents: [x as f32, y as f32, 0.0],
        rate_hz: 0,
    }
}
