//! One finger: a device, its god object, its coupling, its safety and its state.
//!
//! The servo leads all fingers through the stages of a tick, one stage after the other; what happens
//! between them lies in [`crate::fingers::several`].

mod among;
mod inspection;
mod output;
mod point;
mod tool;

use among::Among;
use glam::{DMat3, DVec3};
use triple_buffer::Input;

use crate::body::softening::Blend;
use crate::body::surface::Body;
use crate::control::coupling::Coupler;
use crate::control::safety::Safety;
use crate::control::state::{Findings, Standing};
use crate::device::reason;
use crate::device::{Device, Fault, Probe, Reading};
use crate::proxy::Proxy;
use crate::servo::pressed_patch::PressedPatch;
use crate::servo::settings::{FingerSettings, Moment, Options, Settings};
use crate::servo::snapshot::{FingerReport, Snapshot};
use crate::servo::tip::{Tip, TipHolder, exchange_tips};

/// What the coupling remembers of a tool's touch.
#[derive(Debug, Clone, Copy, Default)]
struct ToolTouch {
    /// Where the probe was when it last did not touch, m.
    begin: DVec3,
    /// Smoothed, N/m.
    stiffness: DMat3,
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
    among: Among,
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
    report: FingerReport,
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
            among: Among::fresh(),
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
            report: FingerReport::default(),
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
            self.report.most_steps = self.report.most_steps.max(proxy.steps());
            self.report.rescues = proxy.rescues();
            self.found.inside = proxy.is_buried();
            if proxy.hold().is_some() {
                self.shot.proxy = proxy.position();
            }
        }
        self.appear(moment.dt, options.limits.ramp_seconds);
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
            self.among = Among::fresh();
        }
        if self.has_tool() {
            if lifted && self.tip_fits {
                self.set_tool_down();
            }
            return;
        }
        let lifted = lifted || std::mem::take(&mut self.among.set_down_again);
        self.among = self.among.carried();
        let seen = self.probe - self.among.moved_back;
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
                Some(tool) => self.tip_fits && tool.felt().is_ok_and(|felt| felt.pressed > 0),
                None => self.proxy.as_ref().is_some_and(|p| p.hold().is_some()),
            }
    }

    /// Whether the others feel it.
    pub fn acts(&self) -> bool {
        self.presence > 0.0 && self.touches()
    }

    /// Whether it has to reckon with what others do or did.
    pub fn is_moved(&self) -> bool {
        self.among.is_moved()
    }

    fn has_motors(&self) -> bool {
        self.reading.probe().is_some_and(Probe::has_motors)
    }
}
