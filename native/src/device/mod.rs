//! The device: what moves the probe and takes the force.

pub mod arrival;
pub mod course;
pub mod haply;
pub mod link;
pub mod pointer;
pub mod reason;
pub mod report;
pub mod serial;
mod speedometer;
mod transit;

use glam::{DMat3, DVec3};

pub use crate::device::report::{Greeting, LinkReport};
use crate::guardian::Watch;

/// Map from the device to the body: `p_body = scale * rotation * p_device + translation`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeviceFrame {
    /// Orthonormal.
    pub rotation: DMat3,
    /// m.
    pub translation: DVec3,
    /// Body metres per device metre.
    pub scale: f64,
    /// Changes with every new frame: the probe jumps then, and must not sweep.
    pub epoch: u32,
}

impl Default for DeviceFrame {
    fn default() -> Self {
        Self {
            rotation: DMat3::IDENTITY,
            translation: DVec3::ZERO,
            scale: 1.0,
            epoch: 0,
        }
    }
}

impl DeviceFrame {
    /// Whether another one maps alike.
    pub fn maps_as(&self, other: &Self) -> bool {
        let epoch = self.epoch;
        *self == Self { epoch, ..*other }
    }

    /// Position in the body of a device position.
    pub fn to_body(&self, p: DVec3) -> DVec3 {
        self.rotation * p * self.scale + self.translation
    }

    /// Force on the device for a force in the body's axes.
    pub fn force_to_device(&self, force: DVec3) -> DVec3 {
        self.rotation.transpose() * force
    }

    /// Rotation from the stylus' axes to the body's, for one to the device's.
    pub fn turn_to_body(&self, orientation: DMat3) -> DMat3 {
        self.rotation * orientation
    }
}

/// Fault: the reason why there is no force although there should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// A position, force or setting is no number, or one that cannot be.
    Nan,
    /// The device moved faster than allowed.
    TooFast,
    /// No sound STATE for 20 ms.
    Stale,
    /// The device does not take force in time: none of it was taken for 20 ms, or what it says is old.
    Deaf,
    /// The port is gone.
    Unplugged,
    /// The device speaks another version of the link.
    Protocol,
    /// The device reported a fault of its own.
    Device,
    /// The servo's thread did not run for more than 20 ms.
    Suspended,
    /// Nobody would say zero should the host end: the guardian has ended, and there is no other yet.
    Unguarded,
    /// The servo itself failed.
    Internal,
}

impl Fault {
    /// All faults, in the order of their numbers.
    pub const ALL: [Self; 10] = [
        Self::Nan,
        Self::TooFast,
        Self::Stale,
        Self::Deaf,
        Self::Unplugged,
        Self::Protocol,
        Self::Device,
        Self::Suspended,
        Self::Unguarded,
        Self::Internal,
    ];

    /// What a tick's look at the guardian comes to.
    pub const fn of_watch(watch: Watch) -> Option<Self> {
        match watch {
            Watch::Kept => None,
            Watch::Spoke => Some(Self::Suspended),
            Watch::Absent => Some(Self::Unguarded),
        }
    }

    /// Name for people and counters.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nan => "nan",
            Self::TooFast => "too fast",
            Self::Stale => "stale",
            Self::Deaf => "deaf",
            Self::Unplugged => "unplugged",
            Self::Protocol => "wrong protocol",
            Self::Device => "device fault",
            Self::Suspended => "suspended",
            Self::Unguarded => "unguarded",
            Self::Internal => "internal error",
        }
    }
}

/// Position, orientation and speed of the probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Position in the body, m.
    pub position: DVec3,
    /// Rotation from the stylus' axes to the body's; a device that does not tell how it is turned
    /// has its own axes, and a pointer the body's. Orthonormal.
    pub orientation: DMat3,
    /// Speed of the device by its own measure, m/s.
    pub speed: f64,
    /// The probe was set down here; no sweep leads from the last position to this one.
    pub restart: bool,
    /// A bit a button.
    pub buttons: u8,
    /// Largest force of the device, N; infinite for a pointer, which has no motors.
    pub max_force: f64,
}

impl Probe {
    /// A probe without motors, turned as the body is.
    pub fn without_motors(position: DVec3, restart: bool) -> Self {
        Self {
            position,
            orientation: DMat3::IDENTITY,
            speed: 0.0,
            restart,
            buttons: 0,
            max_force: f64::INFINITY,
        }
    }

    /// Whether the force reaches a motor, which may make energy with it.
    pub fn has_motors(&self) -> bool {
        self.max_force.is_finite()
    }
}

/// Answer of a device to a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// A position to work with.
    At(Probe),
    /// A position, but the device wants no force; the reason.
    Passive(Probe, &'static str),
    /// Nothing yet; the reason.
    Waiting(&'static str),
    /// Something is wrong.
    Fault(Fault),
}

impl Reading {
    /// The position, where there is one.
    pub fn probe(&self) -> Option<&Probe> {
        match self {
            Self::At(probe) | Self::Passive(probe, _) => Some(probe),
            Self::Waiting(_) | Self::Fault(_) => None,
        }
    }
}

/// A source of positions and sink of forces. Called from the servo thread only.
///
/// `read` and `write` run every tick: they must neither wait nor allocate while the device is in
/// use. A device that has gone may take its time to come back; nothing is touched meanwhile.
pub trait Device: Send {
    /// The newest position at `now` (s since the start), one nominal period `dt` after the last.
    fn read(&mut self, now: f64, dt: f64, frame: &DeviceFrame) -> Reading;
    /// Gives the device its force (N, body axes); `enable` is false whenever it must go limp.
    /// Never left out by accident: one without motors says that it does nothing.
    fn write(&mut self, force: DVec3, enable: bool, frame: &DeviceFrame);
    /// Whether the device shall brake by itself, from the next `write` on, if it can.
    fn brake(&mut self, _wanted: bool) {}
    /// Leaves the device without force for good.
    fn park(&mut self);
    /// Counters for the user.
    fn report(&self) -> LinkReport {
        LinkReport::default()
    }
}
