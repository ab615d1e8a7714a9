//! One tick: read, proxy, contact, safety, write, publish. No allocation, no lock.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use rtrb::Producer;
use triple_buffer::{Input, Output};

use crate::contact::{surface_displacement, touch};
use crate::coupling::Coupling;
use crate::device::{Device, DeviceFrame, Fault, Probe, Reading};
use crate::proxy::{Feel, Proxy};
use crate::recorder::Tape;
use crate::safety::{Limits, Safety};
use crate::snapshot::{Published, Sample, Snapshot, State};
use crate::stages::{Stage, Stages};
use crate::surface::Body;

/// What may change while the servo runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Pa.
    pub young_modulus: f64,
    /// False: zero force at once.
    pub enabled: bool,
    /// Device to body.
    pub frame: DeviceFrame,
    /// Shading and friction.
    pub feel: Feel,
    /// Between body and motors.
    pub coupling: Coupling,
}

/// What is fixed when the servo starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Ticks a second.
    pub rate_hz: u32,
    /// Force limits; the device's own limit is applied too.
    pub limits: Limits,
    /// Fastest device motion under force, m/s.
    pub max_speed: f64,
}

/// The loop's body and memory.
pub struct Servo<D> {
    body: Arc<Body>,
    /// The device in use.
    pub device: D,
    options: Options,
    settings: Output<Settings>,
    snapshots: Input<Published>,
    samples: Producer<Sample>,
    /// Where ticks go while they are recorded.
    pub tape: Option<Tape>,
    proxy: Option<Proxy>,
    probe: DVec3,
    frame_epoch: u32,
    safety: Safety,
    published: Published,
    stages: Arc<Stages>,
}

impl<D: Device> Servo<D> {
    /// A servo at rest.
    pub fn new(
        body: Arc<Body>,
        device: D,
        options: Options,
        mut settings: Output<Settings>,
        snapshots: Input<Published>,
        samples: Producer<Sample>,
    ) -> Self {
        let frame_epoch = settings.read().frame.epoch;
        Self {
            body,
            device,
            options,
            settings,
            snapshots,
            samples,
            tape: None,
            proxy: None,
            probe: DVec3::ZERO,
            frame_epoch,
            safety: Safety::default(),
            published: Published::default(),
            stages: Arc::default(),
        }
    }

    /// Times of the tick's parts, for other threads to read.
    pub fn stages(&self) -> Arc<Stages> {
        self.stages.clone()
    }

    /// Does one tick at `now`, s since the start.
    pub fn tick(&mut self, now: f64) {
        let dt = 1.0 / f64::from(self.options.rate_hz);
        let mut since = Instant::now();
        let settings = *self.settings.read();
        let reading = self.device.read(now, dt, &settings.frame);
        self.stages.end_of(Stage::Read, &mut since);
        let mut shot = Snapshot {
            tick: self.published.snapshot.tick + 1,
            time: now,
            ..Snapshot::default()
        };
        let mut max_force = self.options.limits.max_force;
        match reading {
            Reading::At(probe) | Reading::Passive(probe, _) => {
                shot.buttons = probe.buttons;
                max_force = max_force.min(probe.max_force);
                shot.fault = self.follow(&probe, &settings, dt);
                if shot.fault.is_none() && probe.speed > self.options.max_speed {
                    shot.fault = Some(Fault::TooFast);
                }
            }
            Reading::Waiting(_) => {}
            Reading::Fault(fault) => shot.fault = Some(fault),
        }
        self.stages.end_of(Stage::Proxy, &mut since);
        let lost_sight = matches!(reading, Reading::Fault(_) | Reading::Waiting(_));
        self.feel(&mut shot, lost_sight, settings.young_modulus);
        self.stages.end_of(Stage::Contact, &mut since);
        (shot.state, shot.reason) = judge(&reading, &shot, &settings);
        self.send(&mut shot, max_force, dt, &settings.frame);
        self.stages.end_of(Stage::Write, &mut since);
        self.publish(shot);
    }

    /// Moves the proxy after the probe.
    fn follow(&mut self, probe: &Probe, settings: &Settings, dt: f64) -> Option<Fault> {
        if !probe.position.is_finite() || !probe.speed.is_finite() {
            return Some(Fault::Nan);
        }
        self.probe = probe.position;
        let epoch = settings.frame.epoch;
        let jumped = std::mem::replace(&mut self.frame_epoch, epoch) != epoch;
        match &mut self.proxy {
            Some(proxy) if !probe.restart && !jumped => {
                proxy.follow(&self.body, self.probe, &settings.feel, dt);
            }
            Some(proxy) => proxy.restart(&self.body, self.probe),
            None => self.proxy = Some(Proxy::new(&self.body, self.probe)),
        }
        None
    }

    /// Contact of the proxy and the probe, (11) to (14).
    fn feel(&mut self, shot: &mut Snapshot, lost_sight: bool, young_modulus: f64) {
        shot.probe = self.probe;
        shot.proxy = self.probe;
        let Some(proxy) = &self.proxy else {
            return;
        };
        shot.proxy = proxy.position();
        let (steps, rescues) = (proxy.steps(), proxy.rescues());
        self.published.most_steps = self.published.most_steps.max(steps);
        self.published.rescues = rescues;
        if lost_sight {
            return;
        }
        if let Some(hold) = proxy.hold() {
            let displacement = shot.probe - shot.proxy;
            let touch = touch(
                &self.body,
                hold.triangle,
                hold.alpha,
                displacement,
                young_modulus,
            );
            if !touch.force.is_finite() {
                shot.fault = shot.fault.or(Some(Fault::Nan));
                return;
            }
            shot.sticking = proxy.is_sticking();
            shot.hold = Some((hold.triangle, hold.alpha));
            shot.triangle = self.body.triangles[hold.triangle as usize];
            shot.nodal_forces = touch.nodal_forces;
            shot.contact_force = touch.force;
            shot.surface_point = surface_displacement(
                &self.body,
                hold.triangle,
                hold.alpha,
                &touch.nodal_forces,
                young_modulus,
            )
            .map(|moved| shot.proxy + moved);
        }
    }

    /// Safety, then the device.
    fn send(&mut self, shot: &mut Snapshot, max_force: f64, dt: f64, frame: &DeviceFrame) {
        let permitted = matches!(shot.state, State::Free | State::Touching);
        shot.output_force = if permitted {
            let limits = Limits {
                max_force,
                ..self.options.limits
            };
            self.safety
                .limit(shot.contact_force, &limits, dt)
                .unwrap_or_else(|| {
                    shot.fault = Some(Fault::Nan);
                    (shot.state, shot.reason) = (State::Fault, "");
                    DVec3::ZERO
                })
        } else {
            self.safety.silence()
        };
        let enable = matches!(shot.state, State::Free | State::Touching);
        self.device.write(shot.output_force, enable, frame);
    }

    fn publish(&mut self, shot: Snapshot) {
        if let Some(fault) = shot.fault
            && self.published.snapshot.fault != Some(fault)
        {
            self.published.faults[fault as usize] += 1;
        }
        self.published.snapshot = shot;
        self.published.link = self.device.report();
        let sample = Sample {
            tick: shot.tick,
            time: shot.time,
            probe: shot.probe.to_array(),
            proxy: shot.proxy.to_array(),
            surface: shot.surface_point.unwrap_or(DVec3::NAN).to_array(),
            force: shot.contact_force.to_array(),
            output: shot.output_force.to_array(),
            state: shot.state as u64,
        };
        if self.samples.push(sample).is_err() {
            self.published.samples_lost += 1;
        }
        if let Some(tape) = &mut self.tape {
            tape.put(sample);
        }
        self.snapshots.write(self.published);
    }

    /// Leaves the device limp and says so.
    pub fn park(&mut self, fault: Option<Fault>) {
        self.device.park();
        let shot = &mut self.published.snapshot;
        shot.state = State::Stopped;
        shot.output_force = DVec3::ZERO;
        shot.reason = "";
        shot.fault = fault;
        if let Some(fault) = fault {
            self.published.faults[fault as usize] += 1;
        }
        self.published.link = self.device.report();
        self.snapshots.write(self.published);
    }
}

/// The state that a tick's findings make, and its reason.
fn judge(reading: &Reading, shot: &Snapshot, settings: &Settings) -> (State, &'static str) {
    if shot.fault.is_some() {
        return (State::Fault, "");
    }
    match reading {
        Reading::Waiting(reason) | Reading::Passive(_, reason) => (State::Waiting, reason),
        _ if !settings.enabled => (State::Disabled, "switched off"),
        Reading::At(probe) if probe.buttons != 0 => (State::Disabled, "device button"),
        _ if shot.hold.is_some() => (State::Touching, ""),
        _ => (State::Free, ""),
    }
}
