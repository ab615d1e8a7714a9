//! One tick: read, proxy, contact, safety, write, publish. No allocation, no lock.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use rtrb::Producer;
use triple_buffer::{Input, Output};

use crate::contact::{contact_stiffness, surface_displacement, touch};
use crate::coupling::{Contact, Coupler, Coupling};
use crate::device::{Device, DeviceFrame, Fault, Probe, Reading};
use crate::exchange::{Holder, exchange};
use crate::proxy::{Feel, Proxy};
use crate::recorder::Tape;
use crate::safety::{Limits, Safety};
use crate::snapshot::{Published, Sample, Snapshot};
use crate::stages::{Stage, Stages};
use crate::state::{Findings, Standing, State, reason, transition};
use crate::surface::Body;

/// Two ticks further apart than this were interrupted: the device has gone limp meanwhile, s.
const SUSPENDED_SECONDS: f64 = 0.02;
/// For so long after a gap, what the line had stored may have holes, s.
const HOLES_SECONDS: f64 = 0.05;
/// A device slower than this part of the largest speed is calm.
const CALM_PART: f64 = 0.5;

/// What may change while the servo runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Pa.
    pub young_modulus: f64,
    /// False: zero force at once.
    pub enabled: bool,
    /// Device to body.
    pub frame: DeviceFrame,
    /// Shading, friction and how a contact becomes a force.
    pub feel: Feel,
    /// Between body and motors.
    pub coupling: Coupling,
}

impl Settings {
    /// Maps the device elsewhere: the probe jumps then, and is set down anew.
    pub fn move_device(&mut self, frame: DeviceFrame) {
        self.frame = DeviceFrame {
            epoch: self.frame.epoch.wrapping_add(1),
            ..frame
        };
    }
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
    /// The body to touch, and those that come.
    pub bodies: Holder,
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
    coupler: Coupler,
    safety: Safety,
    standing: Standing,
    /// Time of the last tick, s.
    ticked_at: Option<f64>,
    /// Time of the last tick after a gap, s.
    interrupted_at: f64,
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
            bodies: exchange(body).1,
            device,
            options,
            settings,
            snapshots,
            samples,
            tape: None,
            proxy: None,
            probe: DVec3::ZERO,
            frame_epoch,
            coupler: Coupler::default(),
            safety: Safety::default(),
            standing: Standing::default(),
            ticked_at: None,
            interrupted_at: f64::NEG_INFINITY,
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
        // The body before the settings that belong to it. The exchange keeps it: the end of this
        // tick never frees it.
        let (body, number, body_replaced) = self.bodies.newest();
        let body = Arc::clone(body);
        if body_replaced && let Some(proxy) = &mut self.proxy {
            // Even in a tick without a probe: nothing may be left of the old body.
            proxy.restart(&body, self.probe);
        }
        let settings = *self.settings.read();
        let reading = self.device.read(now, dt, &settings.frame);
        self.stages.end_of(Stage::Read, &mut since);

        let mut shot = Snapshot {
            tick: self.published.snapshot.tick + 1,
            time: now,
            body: number,
            ..Snapshot::default()
        };
        let mut found = self.inspect(now, &reading);
        found.switched_off = !settings.enabled;
        found.body_replaced = body_replaced;
        if !(settings.young_modulus > 0.0 && settings.young_modulus.is_finite()) {
            found.fault = found.fault.or(Some(Fault::Nan));
        }
        if let Some(probe) = reading.probe() {
            shot.buttons = probe.buttons;
            self.follow(&body, probe, &settings, &found, dt);
        }
        self.stages.end_of(Stage::Proxy, &mut since);
        self.feel(&body, &mut shot, &mut found, &settings);
        let wanted = if reading.probe().is_some_and(Probe::has_motors) {
            self.couple(&body, &mut shot, &settings, dt)
        } else {
            shot.contact_force
        };
        self.stages.end_of(Stage::Contact, &mut since);

        self.standing = transition(&self.standing, &found, dt);
        let limits = self.limits_with(&reading);
        self.send(&mut shot, wanted, &found, &limits, dt, &settings.frame);
        self.stages.end_of(Stage::Write, &mut since);
        self.publish(shot);
    }

    /// What the clock and the device tell.
    fn inspect(&mut self, now: f64, reading: &Reading) -> Findings {
        let gap = self.ticked_at.replace(now).map_or(0.0, |last| now - last);
        // While there is no force, a gap endangers nobody.
        if gap > SUSPENDED_SECONDS {
            self.interrupted_at = now;
        }
        let is_suspended = self.standing.fault == Some(Fault::Suspended);
        let was_pushing = is_suspended || self.standing.state.may_push();
        let fault = match reading {
            _ if was_pushing && gap > SUSPENDED_SECONDS => Some(Fault::Suspended),
            Reading::At(probe) | Reading::Passive(probe, _) => match self.fault_of(probe) {
                // What the line had stored has holes, which look like jumps.
                Some(Fault::TooFast)
                    if is_suspended || now - self.interrupted_at < HOLES_SECONDS =>
                {
                    Some(Fault::Suspended)
                }
                fault => fault,
            },
            Reading::Waiting(_) => None,
            Reading::Fault(fault) => Some(*fault),
        };
        let probe = reading.probe();
        Findings {
            fault,
            waiting: match reading {
                Reading::Waiting(reason) | Reading::Passive(_, reason) => Some(reason),
                _ => None,
            },
            blind: probe.is_none(),
            button: probe.is_some_and(|p| p.buttons != 0),
            calm: probe.is_none_or(|p| p.speed <= CALM_PART * self.options.max_speed),
            ramped: self.safety.is_ramped(),
            ..Findings::default()
        }
    }

    fn fault_of(&self, probe: &Probe) -> Option<Fault> {
        let are_numbers = probe.position.is_finite()
            && probe.speed.is_finite()
            && probe.max_force >= 0.0
            && self.options.max_speed.is_finite();
        if !are_numbers {
            Some(Fault::Nan)
        } else if probe.speed > self.options.max_speed {
            Some(Fault::TooFast)
        } else {
            None
        }
    }

    /// Moves the proxy after the probe, or sets it down anew where no sweep leads there.
    fn follow(
        &mut self,
        body: &Body,
        probe: &Probe,
        settings: &Settings,
        found: &Findings,
        dt: f64,
    ) {
        if !probe.position.is_finite() {
            return;
        }
        self.probe = probe.position;
        let epoch = settings.frame.epoch;
        let jumped = std::mem::replace(&mut self.frame_epoch, epoch) != epoch;
        // A device beyond the limit may be one whose encoder has lost its place: where it seems to
        // have gone must not become a depth.
        let lost_its_place =
            found.fault == Some(Fault::TooFast) || self.standing.fault == Some(Fault::TooFast);
        let lifted = probe.restart || jumped || lost_its_place || found.body_replaced;
        match &mut self.proxy {
            Some(proxy) if !lifted => proxy.follow(body, self.probe, &settings.feel, dt),
            Some(proxy) => proxy.restart(body, self.probe),
            None => self.proxy = Some(Proxy::new(body, self.probe)),
        }
    }

    /// Contact of the proxy and the probe, (11) to (14).
    fn feel(
        &mut self,
        body: &Body,
        shot: &mut Snapshot,
        found: &mut Findings,
        settings: &Settings,
    ) {
        let young_modulus = settings.young_modulus;
        shot.probe = self.probe;
        shot.proxy = self.probe;
        let Some(proxy) = &self.proxy else {
            return;
        };
        shot.proxy = proxy.position();
        let (steps, rescues) = (proxy.steps(), proxy.rescues());
        self.published.most_steps = self.published.most_steps.max(steps);
        self.published.rescues = rescues;
        found.inside = proxy.is_buried();
        if found.blind || found.fault == Some(Fault::Nan) {
            return;
        }
        let Some(hold) = proxy.hold() else {
            return;
        };
        let displacement = shot.probe - shot.proxy;
        let mode = settings.feel.mode;
        let touch = touch(
            body,
            mode,
            hold.triangle,
            hold.alpha,
            displacement,
            young_modulus,
        );
        if !touch.force.is_finite() {
            found.fault = found.fault.or(Some(Fault::Nan));
            return;
        }
        found.touching = true;
        shot.sticking = proxy.is_sticking();
        shot.hold = Some((hold.triangle, hold.alpha));
        shot.triangle = body.triangles[hold.triangle as usize];
        shot.nodal_forces = touch.nodal_forces;
        shot.contact_force = touch.force;
        shot.surface_point = surface_displacement(
            body,
            hold.triangle,
            hold.alpha,
            &touch.nodal_forces,
            young_modulus,
        )
        .map(|moved| shot.proxy + moved);
    }

    /// The servo's limits and the device's own, whichever is less; what is no number stays none.
    fn limits_with(&self, reading: &Reading) -> Limits {
        let mut limits = self.options.limits;
        if let Some(probe) = reading.probe()
            && probe.max_force < limits.max_force
        {
            limits.max_force = probe.max_force;
        }
        limits
    }

    /// The force for a device with motors; the surface shown becomes the one that belongs to it.
    fn couple(&mut self, body: &Body, shot: &mut Snapshot, settings: &Settings, dt: f64) -> DVec3 {
        let Some((triangle, alpha)) = shot.hold else {
            self.coupler.release();
            return shot.contact_force;
        };
        let young_modulus = settings.young_modulus;
        let contact = Contact {
            stiffness: contact_stiffness(body, settings.feel.mode, triangle, alpha) * young_modulus,
            displacement: shot.probe - shot.proxy,
            force: shot.contact_force,
        };
        let coupled = self
            .coupler
            .couple(&contact, &settings.coupling, settings.frame.scale, dt);
        let spared = contact.displacement - coupled.body_displacement;
        if spared != DVec3::ZERO {
            let mode = settings.feel.mode;
            let relief = touch(body, mode, triangle, alpha, spared, young_modulus);
            for (force, less) in shot.nodal_forces.iter_mut().zip(relief.nodal_forces) {
                *force -= less;
            }
            shot.surface_point =
                surface_displacement(body, triangle, alpha, &shot.nodal_forces, young_modulus)
                    .map(|moved| shot.proxy + moved);
        }
        coupled.force
    }

    /// Safety, then the device.
    fn send(
        &mut self,
        shot: &mut Snapshot,
        wanted: DVec3,
        found: &Findings,
        limits: &Limits,
        dt: f64,
        frame: &DeviceFrame,
    ) {
        if self.standing.may_push(found) {
            match self.safety.limit(wanted, limits, dt) {
                Some(limited) => {
                    shot.output_force = limited.force;
                    shot.limited = limited.by;
                }
                None => self.standing = Standing::fault(Fault::Nan),
            }
        }
        let may_push = self.standing.may_push(found);
        if !may_push {
            shot.output_force = self.safety.silence();
        }
        shot.state = self.standing.state;
        shot.fault = self.standing.fault;
        shot.reason = self.standing.reason;
        self.coupler.sent(shot.output_force);
        self.device.write(shot.output_force, may_push, frame);
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
        shot.reason = if fault.is_none() { reason::ASKED } else { "" };
        shot.limited = "";
        shot.fault = fault;
        if let Some(fault) = fault {
            self.published.faults[fault as usize] += 1;
        }
        self.published.link = self.device.report();
        self.snapshots.write(self.published);
    }
}
