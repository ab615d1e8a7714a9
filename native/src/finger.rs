//! One finger: a device, its god object, its coupling, its safety and its state.
//!
//! The servo leads all fingers through the stages of a tick, one stage after the other; what happens
//! between them lies in [`crate::several`].

mod point;
mod tool;

use glam::{DMat3, DVec3};
use triple_buffer::Input;

use tool::ToolTouch;

use crate::coupling::{Coupler, Coupling};
use crate::device::{Device, DeviceFrame, Fault, Probe, Reading};
use crate::felt::Blend;
use crate::pressed_patch::PressedPatch;
use crate::proxy::Proxy;
use crate::safety::{Limits, Safety};
use crate::servo::{Options, Settings};
use crate::snapshot::{Sample, Snapshot, Told};
use crate::state::{Findings, Standing, State, reason, transition};
use crate::surface::Body;
use crate::tip::{Tip, TipHolder, exchange_tips};

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
    /// What it touches with.
    pub tips: TipHolder,
    /// Where the patch of a tool is shown.
    pub patches: Option<Input<PressedPatch>>,
    /// Whether the tip can touch the body.
    tip_fits: bool,
    tool_touch: ToolTouch,
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
    blend: Blend,
    safety: Safety,
    standing: Standing,
    /// Time of the last tick after a gap, s.
    interrupted_at: f64,
    /// Of this tick.
    tip_changed: bool,
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
            tips: exchange_tips(Tip::Point).1,
            patches: None,
            tip_fits: true,
            tool_touch: ToolTouch::default(),
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
            blend: Blend::default(),
            safety: Safety::default(),
            standing: Standing::default(),
            interrupted_at: f64::NEG_INFINITY,
            tip_changed: false,
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
        self.tip_changed = self.tips.exchange();
        if self.tip_changed {
            (self.proxy, self.tool_touch) = (None, ToolTouch::default());
        }
        if moment.body_replaced {
            // Even in a tick without a probe: nothing may be left of the old body.
            self.forget_others();
            self.blend.let_go();
            if let Some(proxy) = &mut self.proxy {
                proxy.restart(body, self.probe);
            }
        }
        self.found = self.inspect(moment, options.max_speed);
        self.shot.felt = settings.felt;
        self.found.switched_off = !settings.enabled;
        self.found.body_replaced = moment.body_replaced;
        self.tip_fits = self.tips.tip.fits(body);
        if !self.tip_fits {
            self.found.waiting = self.found.waiting.or(Some(reason::OTHER_BODY));
        }
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
        let lifted =
            probe.restart || jumped || lost_its_place || moment.body_replaced || self.tip_changed;
        if lifted {
            self.forget_others();
            (self.is_fresh, self.set_down_again) = (true, false);
        }
        if self.has_tool() {
            if lifted && self.tip_fits {
                self.set_tool_down();
            }
            return;
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
        is_sound
            && match self.tool() {
                Some(tool) => self.tip_fits && tool.felt().pressed > 0,
                None => self.proxy.as_ref().is_some_and(|p| p.hold().is_some()),
            }
    }

    /// Whether the others feel it.
    pub fn acts(&self) -> bool {
        self.presence > 0.0 && self.touches()
    }

    /// Whether it has to reckon with what others do or did.
    pub fn is_moved(&self) -> bool {
        self.by_others != DVec3::ZERO || self.moved_back != DVec3::ZERO
    }

    fn has_motors(&self) -> bool {
        self.reading.probe().is_some_and(Probe::has_motors)
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
    pub fn tell(&mut self, young_modulus: f64) -> &Told {
        if let (Some(patches), Tip::Tool(tool)) = (&mut self.patches, &self.tips.tip) {
            let tool = self.shot.touching.then_some(&**tool);
            patches
                .input_buffer_mut()
                .show(self.shot.tick, tool, young_modulus);
            patches.publish();
        }
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
