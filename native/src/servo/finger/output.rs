//! What a finger gives: force to the device, and all that others may read of the tick.

use glam::DVec3;

use super::Finger;
use crate::control::safety::Limits;
use crate::control::state::{Standing, State, transition};
use crate::device::reason;
use crate::device::{Fault, Reading};
use crate::servo::settings::FingerSettings;
use crate::servo::snapshot::{FingerReport, Sample};
use crate::servo::tip::Tip;

impl Finger {
    /// State and safety, then the device.
    pub fn send(&mut self, wanted: DVec3, limits: &Limits, own: &FingerSettings, dt: f64) {
        let found = &self.found;
        self.standing = transition(&self.standing, found, dt);
        if self.standing.may_push(found) {
            let limits = limits_with(limits, &self.reading);
            match self.safety.limit(wanted, &limits, dt) {
                Some(limited) => {
                    self.shot.output_force = limited.force;
                    self.shot.limited = limited.by;
                }
                None => self.standing = Standing::fault(Fault::Nan),
            }
        }
        let may_push = self.standing.may_push(found);
        if !may_push {
            self.shot.output_force = self.safety.silence();
        }
        self.shot.state = self.standing.state;
        self.shot.fault = self.standing.fault;
        self.shot.reason = self.standing.reason;
        self.coupler.sent(self.shot.output_force);
        self.device
            .write(self.shot.output_force, may_push, &own.frame);
    }

    /// What the tick came to, for others to read.
    pub fn tell(&mut self, young_modulus: f64) -> &FingerReport {
        if let (Some(patches), Tip::Tool(tool)) = (&mut self.patches, &self.tips.tip) {
            let tool = self.shot.touching.then_some(&**tool);
            patches
                .input_buffer_mut()
                .show(self.shot.tick, tool, young_modulus);
            patches.publish();
        }
        if let Some(fault) = self.shot.fault
            && self.report.snapshot.fault != Some(fault)
        {
            self.report.faults[fault as usize] += 1;
        }
        self.report.snapshot = self.shot;
        self.report.link = self.device.report();
        &self.report
    }

    /// The tick in the recording.
    pub fn sample(&self, finger: u32) -> Sample {
        let shot = &self.shot;
        Sample {
            tick: shot.tick,
            time: shot.time,
            probe: shot.probe.to_array(),
            proxy: shot.proxy.to_array(),
            surface: shot.surface_point.unwrap_or(DVec3::NAN).to_array(),
            force: shot.contact_force.to_array(),
            output: shot.output_force.to_array(),
            state: shot.state as u32,
            finger,
        }
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

/// The servo's limits and the device's own, whichever is less; what is no number stays none.
fn limits_with(limits: &Limits, reading: &Reading) -> Limits {
    let mut limits = *limits;
    if let Some(probe) = reading.probe()
        && probe.max_force < limits.max_force
    {
        limits.max_force = probe.max_force;
    }
    limits
}
