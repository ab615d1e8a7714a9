//! A finger in a tick, before its contact is known.

use glam::DVec3;

use crate::control::coupling::{Contact, Coupled, Coupler};
use crate::control::safety::Limits;
use crate::control::state::Findings;
use crate::control::toll::{Law, Pressed};
use crate::proxy::SurfacePoint;
use crate::servo::settings::{FingerSettings, Moment};
use crate::servo::snapshot::Snapshot;

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
    /// Its force was sent whole, but for the limits.
    pub(super) is_ramped: bool,
    /// No way leads from where it was.
    pub(super) is_set_down: bool,
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

    /// The servo's limits and the device's own, whichever is less; what is no number stays none.
    pub(super) fn limits(&self) -> Limits {
        let Moment {
            options, settings, ..
        } = *self.moment;
        let most = settings.max_force.unwrap_or(options.limits.max_force);
        let device = self.motors.filter(|&force| force < most);
        Limits {
            max_force: device.unwrap_or(most),
            ..options.limits
        }
    }

    /// As the toll sees the finger while it presses nothing.
    pub(super) fn free(&self) -> Pressed {
        Pressed {
            finger: self.shot.probe,
            is_set_down: self.is_set_down,
            place: self.hold.map(|_| self.shot.proxy),
            law: Law {
                modulus: self.moment.settings.young_modulus,
                most_stiffness: self.most_stiffness(),
                most_force: self.limits().max_force,
            },
            ..Pressed::default()
        }
    }

    /// A contact as motors are to make it felt; as it is without them.
    pub(super) fn couple(&self, coupler: &mut Coupler, contact: &Contact) -> Coupled {
        if self.motors.is_none() {
            return Coupled {
                body_displacement: contact.displacement,
                spring: contact.force,
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
