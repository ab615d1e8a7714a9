//! A finger where its device is: its proxy moved after the probe, or its tool set down.

use glam::DVec3;

use super::Finger;
use super::tool::ToolTouch;
use crate::control::coupling::{Contact, Coupled, Coupler};
use crate::control::state::Findings;
use crate::device::{Fault, Probe, Reading};
use crate::proxy::{Proxy, SurfacePoint};
use crate::servo::settings::{FingerSettings, Moment};
use crate::servo::snapshot::Snapshot;
use crate::servo::tip::Tip;

/// A finger in a tick, before its contact is known.
#[derive(Debug, Clone, Copy)]
pub struct Followed<'a> {
    pub(super) moment: &'a Moment<'a>,
    pub(super) own: &'a FingerSettings,
    /// What is known of the tick: where the finger and its proxy are.
    pub(super) shot: Snapshot,
    pub(super) found: Findings,
    /// Largest force of the device, N; none without motors, or without a position.
    pub(super) motors: Option<f64>,
    /// There is a position, and a tip for this body.
    pub(super) is_sound: bool,
    /// The place of a point that touches.
    pub(super) hold: Option<SurfacePoint>,
    pub(super) touches: bool,
    /// From 0 to 1 after a fault.
    pub(super) presence: f64,
}

impl Followed<'_> {
    /// Whether the others feel it.
    pub fn acts(&self) -> bool {
        self.presence > 0.0 && self.touches
    }

    /// From the proxy to the probe, m.
    pub(super) fn displacement(&self) -> DVec3 {
        self.shot.probe - self.shot.proxy
    }

    /// The most that motors may see of the body's stiffness, N/m.
    pub(super) fn most_stiffness(&self) -> f64 {
        self.own.coupling.stiffness / self.own.frame.scale
    }

    /// A contact as motors are to make it felt; as it is without them.
    pub(super) fn couple(&self, coupler: &mut Coupler, contact: &Contact) -> Coupled {
        if self.motors.is_none() {
            return Coupled {
                body_displacement: contact.displacement,
                force: contact.force,
            };
        }
        let own = self.own;
        coupler.couple(contact, &own.coupling, own.frame.scale, self.moment.dt)
    }

    /// The force, N, of a contact in which the coupling's spring is already.
    pub(super) fn drive(&self, coupler: &mut Coupler, seen: &Contact) -> DVec3 {
        if self.motors.is_none() {
            return seen.force;
        }
        let own = self.own;
        coupler.drive(seen, &own.coupling, own.frame.scale, self.moment.dt)
    }
}

impl Finger {
    /// Finds out what is wrong, and moves the proxy after the probe.
    pub fn follow<'a>(
        &mut self,
        moment: &'a Moment<'a>,
        own: &'a FingerSettings,
        reading: &Reading,
    ) -> Followed<'a> {
        let tip_changed = self.tips.exchange();
        if tip_changed {
            (self.point.proxy, self.tool) = (None, ToolTouch::default());
        }
        if moment.body_replaced {
            // Even in a tick without a probe: nothing may be left of the old body.
            self.point.turn_to(moment.body, self.pose.position);
        }
        let tip_fits = self.tips.tip.fits(moment.body);
        let mut found = self.inspect(moment, reading, tip_fits);
        let probe = reading.probe();
        if let Some(probe) = probe {
            self.pose.rotation = probe.orientation * own.orientation;
            if probe.position.is_finite() {
                self.pose.position = probe.position;
                let jumps = self.jumps(own, probe, &found);
                self.go(
                    moment,
                    jumps || moment.body_replaced || tip_changed,
                    tip_fits,
                );
            }
        }
        self.appear(&found, moment);
        let proxy = self.point.proxy.as_ref();
        let hold = proxy.and_then(Proxy::hold);
        found.inside = proxy.is_some_and(Proxy::is_buried);
        let is_sound = !found.blind && found.fault != Some(Fault::Nan) && tip_fits;
        let position = self.pose.position;
        Followed {
            moment,
            own,
            shot: Snapshot {
                tick: moment.tick,
                time: moment.now,
                body: moment.body_number,
                felt: moment.settings.felt,
                buttons: probe.map_or(0, |probe| probe.buttons),
                orientation: self.pose.rotation,
                probe: position,
                proxy: (proxy.filter(|_| hold.is_some())).map_or(position, Proxy::position),
                ..Snapshot::default()
            },
            found,
            motors: probe
                .map(|probe| probe.max_force)
                .filter(|force| force.is_finite()),
            is_sound,
            hold: hold.filter(|_| is_sound),
            touches: is_sound
                && match &self.tips.tip {
                    Tip::Tool(tool) => tool.felt().is_ok_and(|felt| felt.pressed > 0),
                    Tip::Point => hold.is_some(),
                },
            presence: self.presence,
        }
    }

    /// Whether no sweep leads to where the probe is.
    fn jumps(&mut self, own: &FingerSettings, probe: &Probe, found: &Findings) -> bool {
        let epoch = own.frame.epoch;
        let is_elsewhere = std::mem::replace(&mut self.frame_epoch, epoch) != epoch;
        // A device beyond the limit may be one whose encoder has lost its place: where it seems to
        // have gone must not become a depth.
        let too_fast = Some(Fault::TooFast);
        probe.restart || is_elsewhere || [found.fault, self.standing.fault].contains(&too_fast)
    }

    /// Moves the proxy after the probe, or sets the tip down anew.
    fn go(&mut self, moment: &Moment<'_>, is_lifted: bool, tip_fits: bool) {
        if is_lifted {
            self.point.set_down();
        }
        match &mut self.tips.tip {
            Tip::Point => self.point.follow(moment, self.pose.position, is_lifted),
            Tip::Tool(tool) if is_lifted && tip_fits => tool.restart(&self.pose),
            Tip::Tool(_) => {}
        }
    }

    /// Whether the finger is really there; after a fault the others feel it come back gradually.
    fn appear(&mut self, found: &Findings, moment: &Moment<'_>) {
        let ramp_seconds = moment.options.limits.ramp_seconds;
        let is_lifted = found.fault.or(self.standing.fault).is_some() || found.waiting.is_some();
        self.presence = if is_lifted {
            0.0
        } else if ramp_seconds > 0.0 {
            (self.presence + moment.dt / ramp_seconds).min(1.0)
        } else {
            1.0
        };
    }
}
