//! The pointer as a device: glides to the newest target, so that 60 Hz input teleports nothing.

use glam::DVec3;
use triple_buffer::Output;

use crate::device::{Device, DeviceFrame, LinkReport, Probe, Reading};

/// Where the user interface wants the probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Position in the body, m.
    pub position: DVec3,
    /// Changes when the probe shall be set down at the target instead of gliding there. Carried
    /// with the position, so that no newer target can hide it.
    pub epoch: u32,
}

/// A probe led by targets.
#[derive(Debug)]
pub struct Pointer {
    targets: Output<Target>,
    glide_speed: f64,
    position: DVec3,
    epoch: u32,
    set_down: bool,
}

impl Pointer {
    /// A probe set down at `start`, which then follows `targets` at up to `glide_speed` m/s.
    pub fn new(start: Target, targets: Output<Target>, glide_speed: f64) -> Self {
        Self {
            targets,
            glide_speed,
            position: start.position,
            epoch: start.epoch,
            set_down: true,
        }
    }
}

impl Device for Pointer {
    fn read(&mut self, _now: f64, dt: f64, _frame: &DeviceFrame) -> Reading {
        let target = *self.targets.read();
        let lifted = self.epoch != target.epoch;
        let restart = lifted || std::mem::take(&mut self.set_down);
        if lifted {
            self.epoch = target.epoch;
            self.position = target.position;
        } else if !restart {
            let way = target.position - self.position;
            let reach = self.glide_speed * dt;
            self.position = if way.length() <= reach {
                target.position
            } else {
                self.position + way * (reach / way.length())
            };
        }
        Reading::At(Probe {
            position: self.position,
            speed: 0.0,
            restart,
            buttons: 0,
            max_force: f64::INFINITY,
        })
    }

    fn write(&mut self, _force: DVec3, _enable: bool, _frame: &DeviceFrame) {}

    fn park(&mut self) {}

    fn report(&self) -> LinkReport {
        LinkReport::default()
    }
}
