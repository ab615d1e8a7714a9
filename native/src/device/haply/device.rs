//! The 2DIY as a device: torques out, angles in, and a watch on all that is odd.
//!
//! Every tick sends torques; each such request is answered with the angles of its moment. No answer
//! is waited for: what has come by the next tick counts. Boards have no watchdog, so a request with
//! no torque goes out whenever there is the least doubt.

use std::time::Duration;

use glam::{DMat3, DVec3};

use crate::device::haply::flight::Flight;
use crate::device::haply::inbox::Inbox;
use crate::device::haply::message::torque_message;
use crate::device::haply::model::{Model, TORQUE_LIMIT};
use crate::device::haply::newest::Newest;
use crate::device::haply::speed::WindowSpeed;
use crate::device::reason;
use crate::device::serial::line::Line;
use crate::device::serial::wire::Opener;
use crate::device::{Device, DeviceFrame, Fault, LinkReport, Probe, Reading};

/// Answers of the address alone that say that a board has no such device.
const LONE_ADDRESSES: usize = 3;
/// Without an answer for this long there is no force, s.
const STALE_SECONDS: f64 = 0.02;
/// Requests without torque when parking: one may be lost on the wire.
const PARKING_REQUESTS: u32 = 3;
/// Tries, 2 ms each: as long as a full line may take.
const PARKING_PAUSES: u32 = 50;
/// Reads in one tick at most, so that a flood of bytes cannot hold it up.
const READS_PER_TICK: usize = 16;

/// Zero of the angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration {
    /// Angles at the start, degrees (arm 1, arm 2).
    pub degrees: [f32; 2],
    /// Even when the board still knows its angles from an earlier start.
    pub always: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Phase {
    /// Whether the board knows this device; last asked then, if at all.
    Asking { asked: Option<f64>, in_vain: u32 },
    /// Requests and answers.
    Running,
}

impl Phase {
    pub(super) const BEGIN: Self = Self::Asking {
        asked: None,
        in_vain: 0,
    };
}

/// A 2DIY on a line.
pub struct HaplyDevice<O: Opener> {
    pub(super) line: Line<O>,
    /// Received bytes that are no answer yet.
    pub(super) inbox: Inbox,
    pub(super) model: &'static Model,
    pub(super) calibration: Calibration,
    /// The user has said where the handle rests; once, at the start.
    pub(super) may_calibrate: bool,
    /// The angles count from a known pose.
    pub(super) calibrated: bool,
    pub(super) phase: Phase,
    /// Last angles taken or set, degrees.
    pub(super) degrees: Option<[f64; 2]>,
    pub(super) newest: Option<Newest>,
    pub(super) heard: f64,
    pub(super) set_up_at: f64,
    /// The board was set up and has not answered since.
    pub(super) unproven: bool,
    pub(super) now: f64,
    pub(super) unseen: bool,
    pub(super) speed: WindowSpeed,
    pub(super) flight: Flight,
    pub(super) limp: bool,
    pub(super) report: LinkReport,
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

    pub(super) fn address(&self) -> u8 {
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

    fn request(&mut self, torques: Option<[f64; 2]>) {
        let limp = torques.is_none();
        // Behind requests that wait already a new one would only queue; letting go comes first.
        if self.flight.is_full(self.now) && (!limp || self.limp) {
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
        if pose.is_stretched() {
            return None;
        }
        let [first, second] = pose.torques(self.model.to_pantograph(force));
        let most = first.abs().max(second.abs());
        // Both are shortened alike, or the force would turn.
        let share = (TORQUE_LIMIT / most).min(1.0);
        (most > 0.0 && most.is_finite()).then_some([first * share, second * share])
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
        let watch = self.live();
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
        if let Some(fault) = Fault::of_watch(watch) {
            return Reading::Fault(fault);
        }
        if now - self.heard > STALE_SECONDS {
            self.speed.interrupt();
            return Reading::Fault(Fault::Stale);
        }
        let Some(newest) = &mut self.newest else {
            let settled = !self.unproven;
            return Reading::Waiting(if settled {
                reason::NO_ANGLES
            } else {
                reason::SETTING_UP
            });
        };
        let Some(pose) = newest.pose.filter(|_| !newest.is_impossible) else {
            return Reading::Fault(Fault::Device);
        };
        newest.is_told = true;
        let stretched = newest.is_stretched;
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
        let mut taken = 0;
        for _ in 0..PARKING_PAUSES {
            if !self.line.is_open() {
                break;
            }
            self.flight = Flight::default();
            self.limp = false;
            self.request(None);
            taken += u32::from(self.limp);
            // Time for the board to read before the line closes.
            std::thread::sleep(Duration::from_millis(2));
            self.line.flush();
            if taken >= PARKING_REQUESTS && self.line.queued() == 0 {
                break;
            }
        }
        let was_let_go = taken > 0 && self.line.queued() == 0;
        self.line.end(was_let_go);
    }

    fn report(&self) -> LinkReport {
        LinkReport {
            guarded: self.line.is_guarded(),
            ..self.report
        }
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
