//! One finger: a device, its god object, its coupling, its safety and its state.
//!
//! The servo leads all fingers through the stages of a tick, one stage after the other; what happens
//! between them lies in [`crate::several`].

use glam::{DMat3, DVec3};

use crate::contact::{contact_stiffness, surface_displacement, touch};
use crate::coupling::{Contact, Coupler, Coupling};
use crate::device::{Device, DeviceFrame, Fault, Probe, Reading};
use crate::proxy::Proxy;
use crate::safety::{Limits, Safety};
use crate::servo::{Options, Settings};
use crate::several::{Answer, Press};
use crate::snapshot::{Sample, Snapshot, Told};
use crate::state::{Findings, Standing, State, reason, transition};
use crate::surface::Body;
use crate::tree::closest_on_face;

/// Two ticks further apart than this were interrupted: the device has gone limp meanwhile, s.
const SUSPENDED_SECONDS: f64 = 0.02;
/// For so long after a gap, what the line had stored may have holes, s.
const HOLES_SECONDS: f64 = 0.05;
/// A device slower than this part of the largest speed is calm.
const CALM_PART: f64 = 0.5;

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

/// What a tick is for all fingers.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Counts from 1.
    pub tick: u64,
    /// Since the start, s.
    pub now: f64,
    /// Nominal period, s.
    pub dt: f64,
    /// Since the last tick, s; 0 in the first.
    pub gap: f64,
    /// Counts the exchanges of the body.
    pub body: u32,
    /// The body is another one since this tick.
    pub body_replaced: bool,
}

/// A finger.
pub struct Finger {
    /// What moves it.
    pub device: Box<dyn Device>,
    proxy: Option<Proxy>,
    probe: DVec3,
    /// How far the others moved the surface where it touches or will touch in the last tick, m.
    by_others: DVec3,
    /// How far it is moved back from its place before the proxy sees it, m: onto the rest surface.
    moved_back: DVec3,
    /// Unit vector of its push on the body, zero while it has none.
    push_direction: DVec3,
    /// Set down anew: what the others do there is not known yet.
    is_fresh: bool,
    /// That is known since the last tick: it decides on which side the finger was set down.
    set_down_again: bool,
    /// From 0 to 1 after a fault: how much it acts on the others.
    presence: f64,
    frame_epoch: u32,
    coupler: Coupler,
    safety: Safety,
    standing: Standing,
    /// Time of the last tick after a gap, s.
    interrupted_at: f64,
    /// Of this tick.
    reading: Reading,
    found: Findings,
    shot: Snapshot,
    told: Told,
}

impl Finger {
    /// A finger at rest.
    pub fn new(device: Box<dyn Device>, settings: &FingerSettings) -> Self {
        Self {
            device,
            proxy: None,
            probe: DVec3::ZERO,
            by_others: DVec3::ZERO,
            moved_back: DVec3::ZERO,
            push_direction: DVec3::ZERO,
            is_fresh: true,
            set_down_again: false,
            presence: 1.0,
            frame_epoch: settings.frame.epoch,
            coupler: Coupler::default(),
            safety: Safety::default(),
            standing: Standing::default(),
            interrupted_at: f64::NEG_INFINITY,
            reading: Reading::Waiting(""),
            found: Findings::default(),
            shot: Snapshot::default(),
            told: Told::default(),
        }
    }

    /// Asks the device where it is.
    pub fn read(&mut self, moment: &Moment, own: &FingerSettings) {
        self.reading = self.device.read(moment.now, moment.dt, &own.frame);
        self.shot = Snapshot {
            tick: moment.tick,
            time: moment.now,
            body: moment.body,
            orientation: self.shot.orientation,
            ..Snapshot::default()
        };
    }

    /// Finds out what is wrong, and moves the proxy after the probe.
    pub fn follow(
        &mut self,
        body: &Body,
        moment: &Moment,
        settings: &Settings,
        own: &FingerSettings,
        options: &Options,
    ) {
        if moment.body_replaced {
            // Even in a tick without a probe: nothing may be left of the old body.
            self.forget_others();
            if let Some(proxy) = &mut self.proxy {
                proxy.restart(body, self.probe);
            }
        }
        self.found = self.inspect(moment, options.max_speed);
        self.found.switched_off = !settings.enabled;
        self.found.body_replaced = moment.body_replaced;
        if !(settings.young_modulus > 0.0 && settings.young_modulus.is_finite()) {
            self.found.fault = self.found.fault.or(Some(Fault::Nan));
        }
        if let Some(&probe) = self.reading.probe() {
            self.shot.buttons = probe.buttons;
            self.shot.orientation = probe.orientation * own.orientation;
            self.move_proxy(body, &probe, moment, settings, own);
        }
        (self.shot.probe, self.shot.proxy) = (self.probe, self.probe);
        if let Some(proxy) = &self.proxy {
            self.told.most_steps = self.told.most_steps.max(proxy.steps());
            self.told.rescues = proxy.rescues();
            self.found.inside = proxy.is_buried();
            if proxy.hold().is_some() {
                self.shot.proxy = proxy.position();
            }
        }
        self.appear(moment.dt, options.limits.ramp_seconds);
    }

    /// What the clock and the device tell.
    fn inspect(&mut self, moment: &Moment, max_speed: f64) -> Findings {
        let Moment { now, gap, .. } = *moment;
        // While there is no force, a gap endangers nobody.
        if gap > SUSPENDED_SECONDS {
            self.interrupted_at = now;
        }
        let is_suspended = self.standing.fault == Some(Fault::Suspended);
        let was_pushing = is_suspended || self.standing.state.may_push();
        let fault = match &self.reading {
            _ if was_pushing && gap > SUSPENDED_SECONDS => Some(Fault::Suspended),
            Reading::At(probe) | Reading::Passive(probe, _) => match fault_of(probe, max_speed) {
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
        let probe = self.reading.probe();
        Findings {
            fault,
            waiting: match self.reading {
                Reading::Waiting(reason) | Reading::Passive(_, reason) => Some(reason),
                _ => None,
            },
            blind: probe.is_none(),
            button: probe.is_some_and(|p| p.buttons != 0),
            calm: probe.is_none_or(|p| p.speed <= CALM_PART * max_speed),
            ramped: self.safety.is_ramped(),
            ..Findings::default()
        }
    }

    /// Moves the proxy after the probe, or sets it down anew where no sweep leads there.
    ///
    /// The proxy lives on the rest surface: it sees the probe where it would be, had the others not
    /// moved the surface. Across its push a finger holds the surface as it met it.
    fn move_proxy(
        &mut self,
        body: &Body,
        probe: &Probe,
        moment: &Moment,
        settings: &Settings,
        own: &FingerSettings,
    ) {
        if !probe.position.is_finite() {
            return;
        }
        self.probe = probe.position;
        let epoch = own.frame.epoch;
        let jumped = std::mem::replace(&mut self.frame_epoch, epoch) != epoch;
        // A device beyond the limit may be one whose encoder has lost its place: where it seems to
        // have gone must not become a depth.
        let lost_its_place =
            self.found.fault == Some(Fault::TooFast) || self.standing.fault == Some(Fault::TooFast);
        let lifted = probe.restart || jumped || lost_its_place || moment.body_replaced;
        if lifted {
            self.forget_others();
            (self.is_fresh, self.set_down_again) = (true, false);
        }
        let lifted = lifted || std::mem::take(&mut self.set_down_again);
        let n = self.push_direction;
        self.moved_back = if n == DVec3::ZERO {
            self.by_others
        } else {
            self.moved_back + n * n.dot(self.by_others - self.moved_back)
        };
        let seen = self.probe - self.moved_back;
        match &mut self.proxy {
            Some(proxy) if !lifted => proxy.follow(body, seen, &settings.feel, moment.dt),
            Some(proxy) => proxy.restart(body, seen),
            None => self.proxy = Some(Proxy::new(body, seen)),
        }
    }

    /// Whether the finger is really there; after a fault the others feel it come back gradually.
    fn appear(&mut self, dt: f64, ramp_seconds: f64) {
        let is_lifted = self.found.fault.is_some()
            || self.standing.fault.is_some()
            || self.found.waiting.is_some();
        self.presence = if is_lifted {
            0.0
        } else if ramp_seconds > 0.0 {
            (self.presence + dt / ramp_seconds).min(1.0)
        } else {
            1.0
        };
    }

    /// Whether it touches in this tick, by a proxy that can be trusted.
    pub fn touches(&self) -> bool {
        let is_sound = !self.found.blind && self.found.fault != Some(Fault::Nan);
        is_sound && self.proxy.as_ref().is_some_and(|p| p.hold().is_some())
    }

    /// Whether the others feel it.
    pub fn acts(&self) -> bool {
        self.presence > 0.0 && self.touches()
    }

    /// Whether it has to reckon with what others do or did.
    pub fn is_moved(&self) -> bool {
        self.by_others != DVec3::ZERO || self.moved_back != DVec3::ZERO
    }

    /// The finger as the others see it: on the surface, or where it is nearest to that.
    pub fn press(&self, body: &Body, young_modulus: f64, own: &FingerSettings) -> Option<Press> {
        let proxy = self.proxy.as_ref()?;
        if self.acts() {
            let displacement = self.shot.probe - self.shot.proxy;
            let limit = if self.has_motors() {
                own.coupling.stiffness / own.frame.scale / young_modulus
            } else {
                f64::INFINITY
            };
            return Some(Press {
                hold: proxy.hold()?,
                touches: true,
                displacement,
                push: displacement - self.moved_back,
                most_stiffness: limit,
                presence: self.presence,
            });
        }
        if self.found.blind {
            return None;
        }
        let mut hold = proxy.nearest();
        let seen = self.probe - self.moved_back;
        hold.alpha = closest_on_face(body.face(hold.triangle), seen).0;
        Some(Press {
            hold,
            touches: false,
            displacement: DVec3::ZERO,
            push: DVec3::ZERO,
            most_stiffness: f64::INFINITY,
            presence: 0.0,
        })
    }

    /// The contact of a finger that is alone, (11) to (14); what goes to the motors, N.
    pub fn feel_alone(
        &mut self,
        body: &Body,
        settings: &Settings,
        own: &FingerSettings,
        dt: f64,
    ) -> DVec3 {
        let (mode, young_modulus) = (settings.feel.mode, settings.young_modulus);
        let Some((triangle, alpha)) = self.hold() else {
            self.let_go();
            return DVec3::ZERO;
        };
        let displacement = self.shot.probe - self.shot.proxy;
        let touch = |u| touch(body, mode, triangle, alpha, u, young_modulus);
        let whole = touch(displacement);
        if !self.takes(body, (triangle, alpha), whole.force) {
            self.let_go();
            return DVec3::ZERO;
        }
        self.shot.nodal_forces = whole.nodal_forces;
        let mut wanted = whole.force;
        if self.has_motors() {
            let contact = Contact {
                stiffness: contact_stiffness(body, mode, triangle, alpha) * young_modulus,
                displacement,
                force: whole.force,
            };
            let coupled = self
                .coupler
                .couple(&contact, &own.coupling, own.frame.scale, dt);
            wanted = coupled.force;
            let spared = displacement - coupled.body_displacement;
            if spared != DVec3::ZERO {
                let relief = touch(spared).nodal_forces;
                for (force, less) in self.shot.nodal_forces.iter_mut().zip(relief) {
                    *force -= less;
                }
            }
        }
        self.show_surface(body, (triangle, alpha), young_modulus, DVec3::ZERO);
        wanted
    }

    /// The contact of a finger among others; what goes to the motors, N.
    pub fn feel(
        &mut self,
        body: &Body,
        settings: &Settings,
        own: &FingerSettings,
        answer: &Answer,
        dt: f64,
    ) -> DVec3 {
        let young_modulus = settings.young_modulus;
        self.reckon_with(answer);
        let Some(hold) = self.hold() else {
            self.let_go();
            return DVec3::ZERO;
        };
        if !self.acts() {
            // Its contact is lifted: it is followed, for it may come back, but presses nothing.
            let wanted = self.feel_alone(body, settings, own, dt);
            self.shot.nodal_forces = [DVec3::ZERO; 3];
            return wanted;
        }
        let force = answer.force * -young_modulus;
        if !self.takes(body, hold, answer.contact_force * -young_modulus) || !force.is_finite() {
            self.let_go();
            return DVec3::ZERO;
        }
        self.shot.nodal_forces = hold.1.map(|share| force * -share);
        self.show_surface(body, hold, young_modulus, answer.by_others);
        if !self.has_motors() {
            return force;
        }
        let seen = Contact {
            stiffness: answer.seen_stiffness * young_modulus,
            displacement: self.shot.probe - self.shot.proxy - answer.by_others,
            force,
        };
        self.coupler
            .drive(&seen, &own.coupling, own.frame.scale, dt)
    }

    /// Forgets what the others do.
    pub fn forget_others(&mut self) {
        self.by_others = DVec3::ZERO;
        self.moved_back = DVec3::ZERO;
        self.push_direction = DVec3::ZERO;
        self.is_fresh = false;
    }

    /// Notes what the others do at its place, and which way it pushes itself.
    fn reckon_with(&mut self, answer: &Answer) {
        if self.found.blind {
            return;
        }
        self.by_others = answer.by_others;
        if !self.by_others.is_finite() {
            self.forget_others();
        }
        self.set_down_again |= self.is_fresh && self.is_moved() && !self.touches();
        self.is_fresh = false;
        if !self.acts() {
            self.push_direction = DVec3::ZERO;
            return;
        }
        let push = self.shot.probe - self.moved_back - self.shot.proxy;
        let n = push.try_normalize().unwrap_or(self.push_direction);
        self.push_direction = n;
        let slipped = self.moved_back + answer.slip - n * n.dot(answer.slip);
        if slipped.is_finite() {
            self.moved_back = slipped;
        }
    }

    fn hold(&self) -> Option<(u32, [f64; 3])> {
        let hold = self.proxy.as_ref().filter(|_| self.touches())?.hold()?;
        Some((hold.triangle, hold.alpha))
    }

    /// A touch is over. In a tick without a position nobody knows, and the coupling waits.
    fn let_go(&mut self) {
        if self.has_motors() {
            self.coupler.release();
        }
    }

    fn has_motors(&self) -> bool {
        self.reading.probe().is_some_and(Probe::has_motors)
    }

    /// Notes a contact and its force; false if that is no number.
    fn takes(&mut self, body: &Body, hold: (u32, [f64; 3]), force: DVec3) -> bool {
        if !force.is_finite() {
            self.found.fault = self.found.fault.or(Some(Fault::Nan));
            return false;
        }
        self.found.touching = true;
        self.shot.sticking = self.proxy.as_ref().is_some_and(Proxy::is_sticking);
        self.shot.hold = Some(hold);
        self.shot.triangle = body.triangles[hold.0 as usize];
        self.shot.contact_force = force;
        true
    }

    /// Where the touched point of the surface is, by its own nodal forces and the others'.
    fn show_surface(
        &mut self,
        body: &Body,
        (triangle, alpha): (u32, [f64; 3]),
        young_modulus: f64,
        carried: DVec3,
    ) {
        let forces = &self.shot.nodal_forces;
        let moved = surface_displacement(body, triangle, alpha, forces, young_modulus);
        self.shot.surface_point = moved.map(|moved| self.shot.proxy + moved + carried);
    }

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
    pub fn tell(&mut self) -> &Told {
        if let Some(fault) = self.shot.fault
            && self.told.snapshot.fault != Some(fault)
        {
            self.told.faults[fault as usize] += 1;
        }
        self.told.snapshot = self.shot;
        self.told.link = self.device.report();
        &self.told
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
    pub fn park(&mut self, fault: Option<Fault>) -> &Told {
        self.device.park();
        let shot = &mut self.told.snapshot;
        shot.state = State::Stopped;
        shot.output_force = DVec3::ZERO;
        shot.reason = if fault.is_none() { reason::ASKED } else { "" };
        shot.limited = "";
        shot.fault = fault;
        if let Some(fault) = fault {
            self.told.faults[fault as usize] += 1;
        }
        self.told.link = self.device.report();
        &self.told
    }
}

fn fault_of(probe: &Probe, max_speed: f64) -> Option<Fault> {
    let are_numbers = probe.position.is_finite()
        && probe.orientation.is_finite()
        && probe.speed.is_finite()
        && probe.max_force >= 0.0
        && max_speed.is_finite();
    if !are_numbers {
        Some(Fault::Nan)
    } else if probe.speed > max_speed {
        Some(Fault::TooFast)
    } else {
        None
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
