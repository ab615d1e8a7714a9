//! The output of a finger: force to the device, and all that others may read of the tick.

use glam::DVec3;

use super::Finger;
use super::followed::Followed;
use super::touch::Touch;
use crate::control::state::{Standing, State, transition};
use crate::device::Fault;
use crate::device::reason;
use crate::rest::frame::Frame;
use crate::servo::snapshot::{FingerReport, Snapshot};
use crate::servo::tip::Tip;

/// A device that is too fast for so long is really on its way, s: an encoder that lost its place looks
/// so for a moment, and shall not be braked with what it tells.
const RUNAWAY_SECONDS: f64 = 0.02;

impl Finger {
    /// State and safety, then the device.
    pub fn send(&mut self, followed: &Followed<'_>, touch: &Touch) -> Snapshot {
        let (found, dt) = (&touch.found, followed.moment.dt);
        self.standing = transition(&self.standing, found, dt);
        let (mut output_force, mut limited) = (DVec3::ZERO, "");
        if self.standing.may_push(found) {
            let Touch { wanted, brake, .. } = *touch;
            match self.safety.limit(wanted, brake, &followed.limits(), dt) {
                Some(within) => (output_force, limited) = (within.force, within.by),
                None => self.standing = Standing::fault(Fault::Nan),
            }
        }
        let may_push = self.standing.may_push(found);
        if !may_push {
            output_force = self.safety.silence();
        }
        self.coupler.sent(output_force);
        self.brake(found.calm, dt);
        self.device
            .write(output_force, may_push, &followed.own.frame);
        Snapshot {
            output_force,
            limited,
            state: self.standing.state,
            fault: self.standing.fault,
            reason: self.standing.reason,
            ..touch.shot
        }
    }

    /// Has a device that is too fast, and has been for a while, brake by itself.
    fn brake(&mut self, calm: bool, dt: f64) {
        let is_fast = self.standing.fault == Some(Fault::TooFast) && !calm;
        self.fast_for = if is_fast { self.fast_for + dt } else { 0.0 };
        self.device.brake(self.fast_for >= RUNAWAY_SECONDS);
    }

    /// The tick with its counters, for others to read.
    pub fn tell(&mut self, shot: &Snapshot, frame: &Frame, young_modulus: f64) -> &FingerReport {
        if let Tip::Tool(tool) = &self.tips.held {
            let tool = shot.touching.then_some(&**tool);
            (self.patches.input_buffer_mut()).show(shot.tick, tool, frame, young_modulus);
            self.patches.publish();
        }
        let report = &mut self.report;
        if let Some(fault) = shot.fault
            && report.snapshot.fault != Some(fault)
        {
            report.faults[fault as usize] += 1;
        }
        if let Some(proxy) = &self.point.proxy {
            report.most_steps = report.most_steps.max(proxy.steps());
            report.rescues = proxy.rescues();
        }
        report.snapshot = *shot;
        report.link = self.device.report();
        report
    }

    /// Leaves the device limp and says so.
    pub fn park(&mut self, fault: Option<Fault>) -> &FingerReport {
        self.device.park();
        let shot = &mut self.report.snapshot;
        shot.state = State::Stopped;
        shot.output_force = DVec3::ZERO;
        shot.reason = if fault.is_none() { reason::ASKED } else { "" };
        shot.limited = "";
        shot.fault = fault;
        if let Some(fault) = fault {
            self.report.faults[fault as usize] += 1;
        }
        self.report.link = self.device.report();
        &self.report
    }
}
