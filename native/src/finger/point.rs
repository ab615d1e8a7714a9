//! A finger whose tip is a point: its contact alone and among others.

use glam::DVec3;

use super::{Finger, FingerSettings};
use crate::contact::{contact_stiffness, surface_displacement, touch};
use crate::coupling::Contact;
use crate::device::Fault;
use crate::proxy::Proxy;
use crate::servo::Settings;
use crate::several::{Answer, Press};
use crate::surface::Body;
use crate::tree::closest_on_face;

impl Finger {
    /// The finger as the others see it: on the surface, or where it is nearest to that.
    pub fn press(&self, body: &Body, young_modulus: f64, own: &FingerSettings) -> Option<Press> {
        let proxy = self.proxy.as_ref().filter(|_| !self.has_tool())?;
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
                moved_by_tools: DVec3::ZERO,
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
            moved_by_tools: DVec3::ZERO,
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
    pub(super) fn let_go(&mut self) {
        if self.has_motors() {
            self.coupler.release();
        }
    }

    /// Notes a contact and its force; false if that is no number.
    fn takes(&mut self, body: &Body, hold: (u32, [f64; 3]), force: DVec3) -> bool {
        if !force.is_finite() {
            self.found.fault = self.found.fault.or(Some(Fault::Nan));
            return false;
        }
        self.found.touching = true;
        self.shot.touching = true;
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
}
