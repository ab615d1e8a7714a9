//! A finger whose tip is a point: its contact alone and among others.

use glam::DVec3;

use super::among::Among;
use super::followed::Followed;
use super::touch::Touch;
use crate::body::face::closest_on_face;
use crate::body::surface::Body;
use crate::contact::touch::{ContactMode, contact_stiffness, surface_displacement, touch};
use crate::control::coupling::{Contact, Coupled, Coupler};
use crate::fingers::press::{Answer, Press};
use crate::proxy::{Proxy, SurfacePoint};
use crate::servo::settings::Moment;
use crate::servo::snapshot::Snapshot;

/// A point from tick to tick.
pub(super) struct Point {
    pub proxy: Option<Proxy>,
    pub among: Among,
    /// Where the probe was when it last did not touch, m, as the hand sees it.
    pub(super) begin: DVec3,
}

impl Point {
    /// Not set down yet.
    pub fn fresh() -> Self {
        Self {
            proxy: None,
            among: Among::fresh(),
            begin: DVec3::ZERO,
        }
    }

    /// Goes over to another body, near a place.
    pub fn turn_to(&mut self, body: &Body, place: DVec3) {
        self.among = Among::default();
        if let Some(proxy) = &mut self.proxy {
            proxy.restart(body, place);
        }
    }

    /// Is set down: what the others do there is not known yet.
    pub fn set_down(&mut self) {
        self.among = Among::fresh();
    }

    /// Moves the proxy after the probe, or sets it down anew where no sweep leads there.
    ///
    /// The proxy lives on the rest surface: it sees the probe where it would be, had the others not
    /// moved the surface. Across its push a finger holds the surface as it met it.
    pub fn follow(&mut self, moment: &Moment<'_>, probe: DVec3, is_lifted: bool) {
        let is_lifted = is_lifted || std::mem::take(&mut self.among.set_down_again);
        self.among = self.among.carried(moment.frame.is_held());
        let (body, seen) = (moment.body, probe - self.among.moved_back);
        match &mut self.proxy {
            Some(proxy) if !is_lifted => {
                proxy.follow(body, seen, &moment.settings.feel, moment.dt);
            }
            Some(proxy) => proxy.restart(body, seen),
            None => self.proxy = Some(Proxy::new(body, seen)),
        }
    }

    /// The finger as the others see it: on the surface, or where it is nearest to that.
    pub fn press(&mut self, followed: &Followed<'_>) -> Option<Press> {
        let Moment { body, settings, .. } = *followed.moment;
        if let Some(hold) = followed.hold.filter(|_| followed.acts()) {
            let displacement = followed.displacement();
            let push = displacement - self.among.moved_back;
            let limit = followed.most_stiffness() / settings.young_modulus;
            return Some(Press {
                body: 0,
                hold,
                touches: true,
                displacement,
                push,
                cone: self.cone(followed, push),
                most_stiffness: followed.motors.map_or(f64::INFINITY, |_| limit),
                presence: followed.presence,
                remembered: DVec3::ZERO,
                carried: DVec3::ZERO,
            });
        }
        let proxy = self.proxy.as_ref().filter(|_| !followed.found.blind)?;
        let mut hold = proxy.nearest();
        let seen = followed.pose.position - self.among.moved_back;
        hold.alpha = closest_on_face(body.face(hold.triangle), seen).0;
        Some(Press {
            body: 0,
            hold,
            touches: false,
            displacement: DVec3::ZERO,
            push: DVec3::ZERO,
            cone: None,
            most_stiffness: f64::INFINITY,
            presence: 0.0,
            remembered: DVec3::ZERO,
            carried: DVec3::ZERO,
        })
    }

    /// The contact of a finger, among others if they answer.
    pub fn feel(
        &mut self,
        followed: &Followed<'_>,
        answer: Option<&Answer>,
        coupler: &mut Coupler,
    ) -> Touch {
        let acts = followed.acts();
        self.among = match answer {
            None => Among::default(),
            Some(_) if followed.found.blind => self.among,
            Some(answer) => {
                let displacement = acts.then(|| followed.displacement());
                (self.among).after(answer, followed.touches, displacement)
            }
        };
        let Some(hold) = followed.hold else {
            self.begin = followed.shot.probe;
            return Touch::none(followed);
        };
        if let Some(answer) = answer.filter(|_| acts) {
            return self.feel_others(followed, &hold, answer, coupler);
        }
        if !followed.moment.frame.is_held() {
            return self.feel_nothing(followed, acts);
        }
        let mut touch = self.feel_alone(followed, &hold, coupler);
        if answer.is_some() {
            // Its contact is lifted: it is followed, for it may come back, but presses nothing.
            touch.shot.nodal_forces = [DVec3::ZERO; 3];
            touch.pressed = followed.free();
        }
        touch
    }

    /// The contact of a finger that is alone, (11) to (14).
    fn feel_alone(
        &mut self,
        followed: &Followed<'_>,
        hold: &SurfacePoint,
        coupler: &mut Coupler,
    ) -> Touch {
        let Moment { body, settings, .. } = *followed.moment;
        let (mode, young_modulus) = (settings.feel.mode, settings.young_modulus);
        let (triangle, alpha) = (hold.triangle, hold.alpha);
        let displacement = followed.displacement();
        let linear = |u| touch(body, mode, triangle, alpha, u, young_modulus);
        let whole = linear(displacement);
        if !whole.force.is_finite() {
            return Touch::nan(followed);
        }
        let mut coupled = Coupled {
            body_displacement: displacement,
            spring: whole.force,
            force: whole.force,
        };
        let (mut push, mut energy) = (-whole.force, -0.5 * whole.force.dot(displacement));
        if followed.motors.is_some() {
            let stiffness = contact_stiffness(body, mode, triangle, alpha) * young_modulus;
            let contact = Contact {
                stiffness,
                displacement,
                force: whole.force,
            };
            coupled = followed.couple(coupler, &contact);
            push = stiffness * coupled.body_displacement;
            // The coupling's spring holds what it is pressed together by.
            energy = 0.5 * push.dot(displacement);
        }
        let reached = coupled.body_displacement;
        let shot = Snapshot {
            contact_force: whole.force,
            nodal_forces: if reached == displacement {
                whole.nodal_forces
            } else {
                linear(reached).nodal_forces
            },
            ..followed.shot
        };
        let shot = self.on_surface(followed, hold, shot, DVec3::ZERO);
        let touch = Touch::of(followed, shot, coupled.force);
        if mode == ContactMode::Paper {
            // As published: nobody pays.
            return touch;
        }
        touch.with_energy(push, (energy, energy), is_settled(followed))
    }

    /// The contact of a finger among others.
    fn feel_others(
        &self,
        followed: &Followed<'_>,
        hold: &SurfacePoint,
        answer: &Answer,
        coupler: &mut Coupler,
    ) -> Touch {
        let Moment {
            settings, frame, ..
        } = followed.moment;
        let young_modulus = settings.young_modulus;
        let [force, contact_force] =
            [answer.force, answer.contact_force].map(|f| frame.direction(f * -young_modulus));
        if !(force.is_finite() && contact_force.is_finite()) {
            return Touch::nan(followed);
        }
        let shot = Snapshot {
            contact_force,
            nodal_forces: hold
                .alpha
                .map(|share| answer.force * (share * young_modulus)),
            ..followed.shot
        };
        let shot = self.on_surface(followed, hold, shot, answer.by_others + answer.along);
        let seen = Contact {
            stiffness: frame.matrix(answer.seen_stiffness * young_modulus),
            displacement: if frame.is_held() {
                followed.displacement() - answer.by_others
            } else {
                // The hand's own way, not that of the body under it.
                shot.probe - self.begin
            },
            force,
        };
        let energy = [answer.energy, answer.own_energy].map(|e| e * young_modulus);
        let wanted = followed.drive(coupler, &seen);
        let mut touch = Touch::of(followed, shot, wanted).with_energy(
            -force,
            energy.into(),
            is_settled(followed),
        );
        touch.pressed.carried = frame.direction(answer.carried);
        touch.pressed.remembered = answer.remembered * young_modulus;
        touch
    }

    /// A contact with where it is: the touched point of the surface is moved by its own nodal forces
    /// and carried by the others'.
    fn on_surface(
        &self,
        followed: &Followed<'_>,
        &SurfacePoint { triangle, alpha }: &SurfacePoint,
        shot: Snapshot,
        carried: DVec3,
    ) -> Snapshot {
        let Moment { body, settings, .. } = *followed.moment;
        let (forces, young_modulus) = (&shot.nodal_forces, settings.young_modulus);
        let moved = surface_displacement(body, triangle, alpha, forces, young_modulus);
        Snapshot {
            sticking: self.proxy.as_ref().is_some_and(Proxy::is_sticking),
            hold: Some((triangle, alpha)),
            triangle: body.triangles[triangle as usize],
            surface_point: moved.map(|moved| {
                followed
                    .moment
                    .frame
                    .place(followed.proxy + moved + carried)
            }),
            ..shot
        }
    }
}

/// Whether the law stays as it is, and all of it is felt.
fn is_settled(followed: &Followed<'_>) -> bool {
    followed.presence == 1.0 && followed.is_ramped
}
