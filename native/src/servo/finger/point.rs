//! A finger whose tip is a point: its contact alone and among others.

use glam::DVec3;

use super::Finger;
use super::among::Among;
use crate::algebra::series_share;
use crate::body::face::closest_on_face;
use crate::body::softening::Softening;
use crate::body::surface::Body;
use crate::contact::touch::{contact_relation, softened_touch, surface_displacement, touch};
use crate::control::coupling::{Contact, Coupled, series_compliance};
use crate::device::Fault;
use crate::fingers::press::{Answer, Press};
use crate::proxy::Proxy;
use crate::servo::settings::FingerSettings;
use crate::servo::settings::Settings;

impl Finger {
    /// The finger as the others see it: on the surface, or where it is nearest to that.
    pub fn press(
        &mut self,
        body: &Body,
        settings: &Settings,
        own: &FingerSettings,
        dt: f64,
    ) -> Option<Press> {
        let young_modulus = settings.young_modulus;
        let proxy = self.proxy.as_ref().filter(|_| !self.has_tool())?;
        if self.acts() {
            let hold = proxy.hold()?;
            let nodes = body.triangles[hold.triangle as usize];
            let blended = (self.blend).follow(&body.softenings, nodes, settings.felt, dt);
            self.shot.felt_share = blended.share(hold.alpha);
            let displacement = self.shot.probe - self.shot.proxy;
            let limit = if self.has_motors() {
                own.coupling.stiffness / own.frame.scale / young_modulus
            } else {
                f64::INFINITY
            };
            return Some(Press {
                hold,
                touches: true,
                displacement,
                push: displacement - self.among.moved_back,
                most_stiffness: limit,
                presence: self.presence,
                softening: Softening::mixed(&blended.softenings, hold.alpha),
            });
        }
        if self.found.blind {
            return None;
        }
        let mut hold = proxy.nearest();
        let seen = self.probe - self.among.moved_back;
        hold.alpha = closest_on_face(body.face(hold.triangle), seen).0;
        Some(Press {
            hold,
            touches: false,
            displacement: DVec3::ZERO,
            push: DVec3::ZERO,
            most_stiffness: f64::INFINITY,
            presence: 0.0,
            softening: Softening::default(),
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
        let Some(hold @ (triangle, alpha)) = self.hold() else {
            self.let_go();
            return DVec3::ZERO;
        };
        let displacement = self.shot.probe - self.shot.proxy;
        let nodes = body.triangles[triangle as usize];
        let blended = (self.blend).follow(&body.softenings, nodes, settings.felt, dt);
        let linear = |u| touch(body, mode, triangle, alpha, u, young_modulus);
        let softened = |by: &_, u| softened_touch(body, mode, hold, by, u, young_modulus);
        let felt = blended.softenings;
        let is_softened = felt.iter().any(|one| !one.is_none());
        let whole = if is_softened {
            softened(&felt, displacement)
        } else {
            linear(displacement)
        };
        if !self.takes(body, hold, whole.force) {
            self.let_go();
            return DVec3::ZERO;
        }
        let mut wanted = whole.force;
        let mut reached = displacement;
        if self.has_motors() {
            let relation = contact_relation(body, mode, triangle, alpha, &felt);
            let (coupling, scale) = (&own.coupling, own.frame.scale);
            let contact = Contact {
                stiffness: relation.stiffness * young_modulus,
                displacement,
                force: whole.force,
            };
            let coupled = if is_softened {
                let tangent = relation.tangent(displacement) * young_modulus;
                let most = coupling.stiffness / scale;
                let spring = series_compliance(&contact.stiffness, most)
                    .max(series_compliance(&tangent, most));
                let moved = relation.behind_spring(spring * young_modulus, displacement);
                let there = relation.tangent(moved) * young_modulus;
                let seen = Contact {
                    stiffness: series_share(&there, spring) * there,
                    displacement,
                    force: relation.force(moved) * -young_modulus,
                };
                Coupled {
                    body_displacement: moved,
                    force: self.coupler.drive(&seen, coupling, scale, dt),
                }
            } else {
                self.coupler.couple(&contact, coupling, scale, dt)
            };
            (wanted, reached) = (coupled.force, coupled.body_displacement);
        }
        self.shot.nodal_forces = if !is_softened && reached == displacement {
            whole.nodal_forces
        } else {
            linear(reached).nodal_forces
        };
        self.shot.felt_share = blended.share(alpha);
        self.show_surface(body, hold, young_modulus, DVec3::ZERO);
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
        self.shot.felt_share *= answer.felt_share;
        let (drawn, carried) = answer.drawn;
        self.shot.nodal_forces = hold.1.map(|share| drawn * (share * young_modulus));
        self.show_surface(body, hold, young_modulus, carried);
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
        self.among = Among::default();
    }

    /// Notes what the others do at its place, and which way it pushes itself.
    fn reckon_with(&mut self, answer: &Answer) {
        if !self.found.blind {
            let pressed = self.shot.probe - self.shot.proxy;
            let displacement = self.acts().then_some(pressed);
            self.among = self.among.after(answer, self.touches(), displacement);
        }
    }

    fn hold(&self) -> Option<(u32, [f64; 3])> {
        let hold = self.proxy.as_ref().filter(|_| self.touches())?.hold()?;
        Some((hold.triangle, hold.alpha))
    }

    /// A touch is over. In a tick without a position nobody knows, and the coupling waits.
    pub(super) fn let_go(&mut self) {
        self.blend.let_go();
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
