//! Settings of a servo, and the tick that they hold for.

use glam::DMat3;

use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::control::coupling::Coupling;
use crate::control::firmness::Firmness;
use crate::control::safety::Limits;
use crate::creep::relaxation::Creep;
use crate::creep::step::Step;
use crate::device::DeviceFrame;
use crate::proxy::Feel;
use crate::rest::frame::Frame;

/// What may change while the servo runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// In the end, Pa.
    pub young_modulus: f64,
    /// False: zero force at once.
    pub enabled: bool,
    /// The most that any device is told, N; without one, what the servo began with.
    pub max_force: Option<f64>,
    /// How firm the body is beside a linear one, where it presses back in the end.
    pub firmness: Firmness,
    /// How the body gives way with time.
    pub creep: Creep,
    /// Shading, friction and how a contact becomes a force.
    pub feel: Feel,
    /// Of each finger by number; those that are not there have theirs, too.
    pub fingers: [FingerSettings; MAX_FINGERS],
}

impl Settings {
    /// Whatever was not asked for is as plain as it can be.
    pub fn new(young_modulus: f64) -> Self {
        Self {
            young_modulus,
            enabled: true,
            max_force: None,
            firmness: Firmness::default(),
            creep: Creep::default(),
            feel: Feel::default(),
            fingers: [FingerSettings::default(); MAX_FINGERS],
        }
    }
}

/// What is fixed when the servo starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Ticks a second.
    pub rate_hz: u32,
    /// Force limits; a device's own limit is applied too.
    pub limits: Limits,
    /// Fastest device motion under force, m/s.
    pub max_speed: f64,
}

/// What may change of one finger while the servo runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FingerSettings {
    /// Device to body.
    pub frame: DeviceFrame,
    /// Between body and motors.
    pub coupling: Coupling,
    /// How a tool is attached to the device: turns its directions to those of the device's stylus.
    pub orientation: DMat3,
}

impl Default for FingerSettings {
    fn default() -> Self {
        Self {
            frame: DeviceFrame::default(),
            coupling: Coupling::default(),
            orientation: DMat3::IDENTITY,
        }
    }
}

impl FingerSettings {
    /// Maps the device elsewhere: the probe jumps then, and is set down anew.
    pub fn move_device(&mut self, frame: DeviceFrame) {
        self.frame = DeviceFrame {
            epoch: self.frame.epoch.wrapping_add(1),
            ..frame
        };
    }
}

/// Firmness in a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Firm {
    /// Young's modulus without it, Pa.
    pub modulus: f64,
    /// Factor of all forces, in Young's modulus of the tick already.
    pub share: f64,
    /// By how much more steeply they grow, 1 or more.
    pub steepness: f64,
}

/// A tick, the same for all fingers.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// Counts from 1.
    pub tick: u64,
    /// Since the start, s.
    pub now: f64,
    /// Nominal period, s.
    pub dt: f64,
    /// Since the last tick, s; 0 in the first.
    pub gap: f64,
    /// What is touched.
    pub body: &'a Body,
    /// Counts the exchanges of the body.
    pub body_number: u32,
    /// The body is another one since this tick, or was laid elsewhere.
    pub body_replaced: bool,
    /// It is among others that it presses: only tools feel it.
    pub is_among: bool,
    /// The body's frame, as the hands see it when the tick begins.
    pub frame: Frame,
    /// How the body gives way with time in this tick.
    pub creep: Step,
    /// Share of Young's modulus that comes of the body's firmness, and how much more steeply forces grow.
    pub firmness: Option<Firm>,
    /// In force, Young's modulus that of the tick.
    pub settings: &'a Settings,
    /// Fixed at the start.
    pub options: &'a Options,
}
