//! A finger whose tip is a point: its contact alone and among others.

use glam::DVec3;

use super::among::Among;
use super::followed::Followed;
use super::touch::Touch;
use crate::algebra::series_share;
use crate::body::face::closest_on_face;
use crate::body::softening::blend::Blend;
use crate::body::softening::{Relation, Softening};
use crate::body::surface::Body;
use crate::contact::touch::{
    ContactMode, contact_relation, softened_touch, surface_displacement, touch,
};
use crate::control::coupling::{Contact, Coupled, Coupler, series_compliance};
use crate::fingers::press::{Answer, Press};
use crate::proxy::{Proxy, SurfacePoint};
use crate::servo::settings::Moment;
use crate::servo::snapshot::Snapshot;

/// A point from tick to tick.
pub(super) struct Point {
    pub proxy: Option<Proxy>,
    pub among: Among,
    pub blend: Blend,
}

impl Point {
    /// Not set down yet.
    pub fn fresh() -> Self {
        Self {
            proxy: None,
            among: Among::fresh(),
            blend: Blend::default(),
        }
    }

    /// Goes over to another body, near a place.
    pub fn turn_to(&mut self, body: &Body, place: DVec3) {
        self.among = Among::default();
        self.blend.let_go();
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
        self.among = self.among.carried();
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
            let limit = followed.most_stiffness() / settings.young_modulus;
            return Some(Press {
                body: 0,
                hold,
                touches: true,
                displacement,
                push: displacement - self.among.moved_back,
                most_stiffness: followed.motors.map_or(f64::INFINITY, |_| limit),
                presence: followed.presence,
                softening: Softening::mixed(&self.softenings(followed, &hold), hold.alpha),
            });
        }
        let proxy = self.proxy.as_ref().filter(|_| !followed.found.blind)?;
        let mut hold = proxy.nearest();
        let seen = followed.shot.probe - self.among.moved_back;
        hold.alpha = closest_on_face(body.face(hold.triangle), seen).0;
        Some(Press {
            body: 0,
            hold,
            touches: false,
            displacement: DVec3::ZERO,
            push: DVec3::ZERO,
            most_stiffness: f64::INFINITY,
            presence: 0.0,
            softening: Softening::default(),
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
            return Touch::none(followed);
        };
        if let Some(answer) = answer.filter(|_| acts) {
            return self.feel_others(followed, &hold, answer, coupler);
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
        let place @ (triangle, alpha) = (hold.triangle, hold.alpha);
        let displacement = followed.displacement();
        let felt = self.softenings(followed, hold);
        let linear = |u| touch(body, mode, triangle, alpha, u, young_modulus);
        let is_softened = felt.iter().any(|one| !one.is_none());
        let whole = if is_softened {
            softened_touch(body, mode, place, &felt, displacement, young_modulus)
        } else {
            linear(displacement)
        };
        if !whole.force.is_finite() {
            return Touch::nan(followed);
        }
        let mut coupled = Coupled {
            body_displacement: displacement,
            spring: whole.force,
            force: whole.force,
        };
        let (mut push, mut energy) = (-whole.force, -0.5 * whole.force.dot(displacement));
        if is_softened || followed.motors.is_some() {
            let relation = contact_relation(body, mode, triangle, alpha, &felt);
            coupled = if followed.motors.is_none() {
                coupled
            } else if is_softened {
                drive_softened(followed, &relation, coupler)
            } else {
                let contact = Contact {
                    stiffness: relation.stiffness * young_modulus,
                    displacement,
                    force: whole.force,
                };
                followed.couple(coupler, &contact)
            };
            let moved = coupled.body_displacement;
            push = relation.force(moved) * young_modulus;
            // The coupling's spring holds what it is pressed together by.
            energy = relation.energy(moved) * young_modulus + 0.5 * push.dot(displacement - moved);
        }
        let reached = coupled.body_displacement;
        let shot = Snapshot {
            contact_force: whole.force,
            nodal_forces: if !is_softened && reached == displacement {
                whole.nodal_forces
            } else {
                linear(reached).nodal_forces
            },
            felt_share: self.blend.share(alpha),
            ..followed.shot
        };
        let shot = self.on_surface(followed, hold, shot, DVec3::ZERO);
        let touch = Touch::of(followed, shot, coupled.force);
        if mode == ContactMode::Paper {
            // As published: nobody pays.
            return touch;
        }
        touch.with_energy(push, (energy, energy), self.is_settled(followed))
    }

    /// The contact of a finger among others.
    fn feel_others(
        &self,
        followed: &Followed<'_>,
        hold: &SurfacePoint,
        answer: &Answer,
        coupler: &mut Coupler,
    ) -> Touch {
        let young_modulus = followed.moment.settings.young_modulus;
        let [force, contact_force] =
            [answer.force, answer.contact_force].map(|f| f * -young_modulus);
        if !(force.is_finite() && contact_force.is_finite()) {
            return Touch::nan(followed);
        }
        let (drawn, carried) = answer.drawn;
        let shot = Snapshot {
            contact_force,
            nodal_forces: hold.alpha.map(|share| drawn * (share * young_modulus)),
            felt_share: self.blend.share(hold.alpha) * answer.felt_share,
            ..followed.shot
        };
        let shot = self.on_surface(followed, hold, shot, carried);
        let seen = Contact {
            stiffness: answer.seen_stiffness * young_modulus,
            displacement: followed.displacement() - answer.by_others,
            force,
        };
        let by_others = 0.5 * answer.force.dot(answer.by_others);
        let energy = [answer.energy, answer.energy - by_others].map(|e| e * young_modulus);
        let is_settled = answer.is_settled && self.is_settled(followed);
        let wanted = followed.drive(coupler, &seen);
        Touch::of(followed, shot, wanted).with_energy(-force, energy.into(), is_settled)
    }

    /// Whether the law stays as it is, and all of it is felt.
    fn is_settled(&self, followed: &Followed<'_>) -> bool {
        self.blend.is_settled() && followed.presence == 1.0 && followed.is_ramped
    }

    /// Softenings of the touched triangle's nodes, as they are felt in this tick.
    fn softenings(&mut self, followed: &Followed<'_>, hold: &SurfacePoint) -> [Softening; 3] {
        let Moment {
            body, settings, dt, ..
        } = *followed.moment;
        let nodes = body.triangles[hold.triangle as usize];
        (self.blend).follow(&body.softenings, nodes, settings.felt, dt)
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
            surface_point: moved.map(|moved| shot.proxy + moved + carried),
            ..shot
        }
    }
}

/// A place that softens and the coupling's spring in series, damped.
fn drive_softened(followed: &Followed<'_>, relation: &Relation, coupler: &mut Coupler) -> Coupled {
    let young_modulus = followed.moment.settings.young_modulus;
    let (displacement, most) = (followed.displacement(), followed.most_stiffness());
    let tangent = relation.tangent(displacement) * young_modulus;
    let spring = series_compliance(&(relation.stiffness * young_modulus), most)
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
        spring: seen.force,
        force: followed.drive(coupler, &seen),
    }
}
