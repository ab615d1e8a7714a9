//! What the servo asks of whatever moves the probe and takes the force.

pub mod arrival;
pub mod haply;
pub mod link;
pub mod pointer;
pub mod reason;
pub mod serial;
mod speedometer;

use glam::{DMat3, DVec3};

use crate::device::arrival::Rhythm;

/// How device coordinates lie in the body: `p_body = scale * rotation * p_device + translation`.
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

/// Why there is no force although there should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// A position, force or setting is no number, or one that cannot be.
    Nan,
    /// The device moved faster than allowed.
    TooFast,
    /// No sound STATE for 20 ms.
    Stale,
    /// The port is gone.
    Unplugged,
    /// The device speaks another version of the link.
    Protocol,
    /// The device reported a fault of its own.
    Device,
    /// The servo's thread did not run for more than 20 ms.
    Suspended,
    /// The servo itself failed.
    Internal,
}

impl Fault {
    /// All faults, in the order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::Nan,
        Self::TooFast,
        Self::Stale,
        Self::Unplugged,
        Self::Protocol,
        Self::Device,
        Self::Suspended,
        Self::Internal,
    ];

    /// Name for people and counters.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nan => "nan",
            Self::TooFast => "too fast",
            Self::Stale => "stale",
            Self::Unplugged => "unplugged",
            Self::Protocol => "wrong protocol",
            Self::Device => "device fault",
            Self::Suspended => "suspended",
            Self::Internal => "internal error",
        }
    }
}

/// Where the probe is.
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
    /// Whether the force reaches a motor, which may make energy with it.
    pub fn has_motors(&self) -> bool {
        self.max_force.is_finite()
    }
}

/// What a device answers each tick.
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

/// What happened on a link so far; all zero for a pointer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LinkReport {
    /// Valid STATE messages.
    pub states: u64,
    /// FORCE messages sent.
    pub forces: u64,
    /// STATE messages missing by their sequence numbers.
    pub lost: u64,
    /// STATE messages with the sequence number of the one before.
    pub duplicates: u64,
    /// STATE messages older than the one before; not used.
    pub out_of_order: u64,
    /// Frames with a wrong checksum.
    pub crc_errors: u64,
    /// Frames that are not COBS.
    pub cobs_errors: u64,
    /// Frames that are too long.
    pub oversize: u64,
    /// Sound frames of unknown type or length.
    pub unknown: u64,
    /// ORIENTATION messages that came with their STATE.
    pub orientations: u64,
    /// ORIENTATION messages whose STATE did not come, or was not used.
    pub orientations_unpaired: u64,
    /// ORIENTATION messages that hold no unit quaternion.
    pub orientations_refused: u64,
    /// STATE messages without ORIENTATION of a device that has told one.
    pub orientations_lost: u64,
    /// HELLO messages sent.
    pub hellos: u64,
    /// FAULT messages of the device.
    pub device_faults: u64,
    /// FORCE messages not sent because the port took no more.
    pub unsent: u64,
    /// Times the port was opened again.
    pub reopened: u64,
    /// Code and detail of the device's last FAULT.
    pub last_fault: Option<(u8, u16)>,
    /// When STATE messages arrived.
    pub rhythm: Rhythm,
    /// The device's greeting.
    pub greeting: Option<crate::device::link::codec::Greeting>,
}

/// A source of positions and sink of forces. Called from the servo thread only.
///
/// `read` and `write` run every tick: they must neither wait nor allocate while the device is in
/// use. A device that has gone may take its time to come back; nothing is touched meanwhile.
pub trait Device: Send {
    /// The newest position at `now` (s since the start), one nominal period `dt` after the last.
    fn read(&mut self, now: f64, dt: f64, frame: &DeviceFrame) -> Reading;
    /// Gives the device its force (N, body axes); `enable` is false whenever it must go limp.
    fn write(&mut self, force: DVec3, enable: bool, frame: &DeviceFrame);
    /// Leaves the device without force for good.
    fn park(&mut self);
    /// Counters for the user.
    fn report(&self) -> LinkReport;
}
