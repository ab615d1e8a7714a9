//! The pointer as a device: it glides to the newest target, so that 60 Hz input makes no jumps.

use glam::DVec3;
use triple_buffer::Output;

use crate::device::{Device, DeviceFrame, Probe, Reading};

/// Target of the probe, from the user interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Position in the body, m.
    pub position: DVec3,
    /// Place where the probe was last set down instead of gliding there, m.
    pub set_down: DVec3,
    /// Changes with every `set_down`. Both are carried on by newer targets, so that none of them
    /// can hide that the probe was set down, or where.
    pub epoch: u32,
}

impl Target {
    /// A first target, with the probe set down there.
    pub fn first(position: DVec3) -> Self {
        Self {
            position,
            set_down: position,
            epoch: 0,
        }
    }

    /// The target after this one.
    pub fn next(self, position: DVec3, restart: bool) -> Self {
        if restart {
            Self {
                epoch: self.epoch.wrapping_add(1),
                ..Self::first(position)
            }
        } else {
            Self { position, ..self }
        }
    }
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
            position: start.set_down,
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
            self.position = target.set_down;
        } else if !restart {
            let way = target.position - self.position;
            let reach = self.glide_speed * dt;
            self.position = if way.length() <= reach {
                target.position
            } else {
                self.position + way * (reach / way.length())
            };
        }
        Reading::At(Probe::without_motors(self.position, restart))
    }

    fn write(&mut self, _force: DVec3, _enable: bool, _frame: &DeviceFrame) {}

    fn park(&mut self) {}
}
