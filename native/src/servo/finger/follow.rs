//! A finger where its device is: its proxy moved after the probe, or its tool set down.

use super::Finger;
use super::followed::Followed;
use super::tool::ToolTouch;
use crate::control::state::Findings;
use crate::device::{Fault, Probe, Reading};
use crate::proxy::Proxy;
use crate::servo::settings::{FingerSettings, Moment};
use crate::servo::snapshot::Snapshot;
use crate::servo::tip::Tip;
use crate::tool::shape::Pose;

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
            let seen = moment.frame.to_body(&self.pose);
            self.point.turn_to(moment.body, seen.position);
        }
        let tip_fits = self.tips.held.fits(moment.body) && (self.has_tool() || !moment.is_among);
        let mut found = self.inspect(moment, reading, tip_fits);
        let probe = reading.probe();
        let mut is_set_down = moment.body_replaced || tip_changed;
        if let Some(probe) = probe {
            self.pose.rotation = probe.orientation * own.orientation;
            if probe.position.is_finite() {
                self.pose.position = probe.position;
                is_set_down |= self.jumps(own, probe, &found);
                let seen = moment.frame.to_body(&self.pose);
                self.go(moment, &seen, is_set_down, tip_fits);
            }
        }
        self.appear(&found, moment);
        let proxy = self.point.proxy.as_ref();
        let hold = proxy.and_then(Proxy::hold);
        found.inside = proxy.is_some_and(Proxy::is_buried);
        let is_sound = !found.blind && found.fault != Some(Fault::Nan) && tip_fits;
        let pose = moment.frame.to_body(&self.pose);
        let proxy = (proxy.filter(|_| hold.is_some())).map_or(pose.position, Proxy::position);
        Followed {
            moment,
            own,
            shot: Snapshot {
                tick: moment.tick,
                time: moment.now,
                body: moment.body_number,
                buttons: probe.map_or(0, |probe| probe.buttons),
                orientation: self.pose.rotation,
                probe: self.pose.position,
                proxy: moment.frame.place(proxy),
                ..Snapshot::default()
            },
            pose,
            proxy,
            found,
            motors: probe
                .map(|probe| probe.max_force)
                .filter(|force| force.is_finite()),
            is_sound,
            hold: hold.filter(|_| is_sound),
            touches: is_sound
                && match &self.tips.held {
                    Tip::Tool(tool) => tool.felt().is_ok_and(|felt| felt.pressed > 0),
                    Tip::Point => hold.is_some(),
                },
            presence: self.presence,
            is_ramped: self.safety.is_ramped(),
            is_set_down,
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
    fn go(&mut self, moment: &Moment<'_>, seen: &Pose, is_lifted: bool, tip_fits: bool) {
        if is_lifted {
            self.point.set_down();
        }
        match &mut self.tips.held {
            Tip::Point => self.point.follow(moment, seen.position, is_lifted),
            Tip::Tool(tool) if is_lifted && tip_fits => tool.restart(seen),
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
