//! A finger in a tick, before its contact is known.

use glam::DVec3;

use crate::control::coupling::{Contact, Coupled, Coupler};
use crate::control::pressed::{Law, Pressed};
use crate::control::safety::Limits;
use crate::control::state::Findings;
use crate::proxy::SurfacePoint;
use crate::servo::settings::{FingerSettings, Moment};
use crate::servo::snapshot::Snapshot;
use crate::tool::shape::Pose;

/// A finger in a tick, before its contact is known.
#[derive(Debug, Clone, Copy)]
pub struct Followed<'a> {
    pub(super) moment: &'a Moment<'a>,
    pub(super) own: &'a FingerSettings,
    /// What is known of the tick: where the finger and its proxy are, as the hand sees them.
    pub(super) shot: Snapshot,
    /// The finger, as seen from the body.
    pub(super) pose: Pose,
    /// Its proxy, as seen from the body, m.
    pub(super) proxy: DVec3,
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

    /// From the proxy to the probe, m, in the body's axes.
    pub(super) fn displacement(&self) -> DVec3 {
        self.pose.position - self.proxy
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
        let firm = &self.moment.firmness;
        Pressed {
            finger: self.shot.probe,
            is_set_down: self.is_set_down,
            // On a body that moves no place stays, and where firmness changes no work is known.
            place: (self.hold)
                .filter(|_| self.moment.frame.is_held() && firm.is_none())
                .map(|_| self.proxy),
            law: Law {
                modulus: firm.map_or(self.moment.settings.young_modulus, |firm| firm.modulus),
                most_stiffness: self.most_stiffness(),
                most_force: self.limits().max_force,
            },
            ..Pressed::default()
        }
    }

    /// A contact as the coupling is to see it: as stiff as its force grows.
    fn steep(&self, contact: &Contact) -> Contact {
        let steepness = self.moment.firmness.map_or(1.0, |firm| firm.steepness);
        Contact {
            stiffness: contact.stiffness * steepness,
            ..*contact
        }
    }

    /// A contact, in the hand's axes, as motors are to make it felt; as it is without them.
    pub(super) fn couple(&self, coupler: &mut Coupler, contact: &Contact) -> Coupled {
        if self.motors.is_none() {
            return Coupled {
                body_displacement: contact.displacement,
                spring: contact.force,
                force: contact.force,
            };
        }
        let own = self.own;
        coupler.couple(
            &self.steep(contact),
            &own.coupling,
            own.frame.scale,
            self.moment.dt,
        )
    }

    /// The force, N, of a contact, in the hand's axes, in which the coupling's spring is already.
    pub(super) fn drive(&self, coupler: &mut Coupler, seen: &Contact) -> DVec3 {
        if self.motors.is_none() {
            return seen.force;
        }
        let own = self.own;
        coupler.drive(
            &self.steep(seen),
            &own.coupling,
            own.frame.scale,
            self.moment.dt,
        )
    }
}
