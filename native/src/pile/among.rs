//! A body among others that it presses, in the tick: all of them one pile, pressed by hands.

use glam::{DMat3, DVec3};

use super::contact::{Against, Contact, MOST_SHARES};
use super::obstacle::Rigid;
use super::piled::Pile;
use crate::algebra::MOST_IN_TICK;
use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::MOST_SUPPORTS;
use crate::engine::joint::{AllLed, Led};
use crate::rest::borne::MOST_BORNE;
use crate::rest::placement::Placement;
use crate::tool::collider::side::is_outside;
use crate::tool::collider::{Collider, Felt};
use crate::tool::complementarity::stiffness::with_stuck;
use crate::tool::shape::Pose;
use crate::tool::slot::{MOST_NODES, Slot};

/// The body that tools are made for.
const TOUCHED: usize = 0;
// All contacts that press may be on one body.
const _: () = assert!(3 * MOST_SHARES * MOST_IN_TICK <= MOST_BORNE);
const _: () = assert!(MOST_SUPPORTS * MOST_NODES <= MOST_BORNE);

/// A body, the first of a pile, among the others.
#[derive(Debug)]
pub struct Among {
    pile: Pile,
    /// Whose contacts there are, by finger.
    eras: [Option<u64>; MAX_FINGERS],
}

/// With all the memory that it ever needs.
impl Clone for Among {
    fn clone(&self) -> Self {
        Self {
            eras: self.eras,
            ..Self::new(self.pile.clone())
        }
    }
}

impl Among {
    /// A pile as it lies, whose first body hands touch, and the others through their tools, too. From
    /// now on it takes no memory.
    pub fn new(mut pile: Pile) -> Self {
        pile.hurry();
        Self {
            pile,
            eras: [None; MAX_FINGERS],
        }
    }

    /// The body that tools are made for.
    pub fn body(&self) -> &std::sync::Arc<Body> {
        self.pile.members[TOUCHED].touchable.own().body()
    }

    /// Where that is.
    pub fn placement(&self) -> Placement {
        self.pile.members[TOUCHED].placement
    }

    /// Where the others are, in their order.
    pub fn others(&self) -> impl Iterator<Item = Placement> + '_ {
        let others = self.pile.members[TOUCHED + 1..].iter();
        others.map(|member| member.placement)
    }

    /// What the weight of all bodies can give back, J, from the height of the world's origin on.
    pub fn raised(&self) -> f64 {
        let (members, gravity) = (self.pile.members.iter(), self.pile.gravity);
        members.map(|member| member.raised(gravity)).sum()
    }

    /// What others than fingers hold in all bodies, J.
    pub fn held(&self) -> f64 {
        let is_other = |contact: &&Contact| !matches!(contact.against, Against::Finger(_));
        let others = self.pile.contacts().iter().filter(is_other);
        others.map(|contact| self.held_by(contact)).sum()
    }

    /// The elastic energy in the touched body, J.
    pub fn elastic(&self) -> f64 {
        self.pile.members[TOUCHED].elastic()
    }

    /// How many bodies there are, the touched one among them.
    pub fn count(&self) -> usize {
        self.pile.members.len()
    }

    /// Forces on the nodes of a body, N in its axes: of the touched one, 0, those of all but fingers.
    pub fn borne(&self, body: usize) -> impl Iterator<Item = (u32, DVec3)> + '_ {
        let member = &self.pile.members[body];
        let turn = member.placement.rotation.inverse();
        let bears = move |contact: &&Contact| {
            let by_finger = matches!(contact.against, Against::Finger(_));
            contact.push > 0.0 && !(by_finger && body == TOUCHED)
        };
        let contacts = self.pile.contacts().iter().filter(bears);
        contacts.flat_map(move |contact| {
            let force = turn * contact.force() * contact.sign_on(body);
            let shares = contact.shares_on(body).iter();
            shares.flat_map(move |&(point, share)| {
                let at = member.touchable.point(point);
                let nodes = at.nodes.into_iter().zip(at.alpha);
                nodes.map(move |(node, weight)| (node, force * (share * weight)))
            })
        })
    }

    /// A tick of `dt` s, in which tools go to where they are led, seen from the touched body, whose
    /// Young's modulus is told, Pa; each keeps what it felt.
    pub fn tick(&mut self, led: &mut AllLed<'_>, young_modulus: f64, dt: f64) {
        self.pile.members[TOUCHED].young_modulus = young_modulus;
        let before = self.placement();
        self.begin(led, &before);
        let mut fingers = [None; MAX_FINGERS];
        for (number, rigid) in fingers.iter_mut().enumerate() {
            let led = led[number].as_ref().filter(|_| self.eras[number].is_some());
            *rigid = led.and_then(|led| rigid_of(led, &before));
        }
        let poses = fingers.map(|rigid| rigid.map(|rigid| rigid.pose));
        let is_sound = self.pile.tick_with(&fingers, dt).is_ok();
        if !is_sound {
            self.pile.let_go(|_| true);
        }
        for (number, pose) in poses.into_iter().enumerate() {
            let (Some(pose), Some(led)) = (pose, led[number].as_mut()) else {
                continue;
            };
            if is_sound {
                self.feel(number, led.collider, &before, &pose);
            } else {
                led.collider.fail();
            }
        }
    }

    /// Tools take their way; contacts of those that are not there any more, or feel nothing, go.
    fn begin(&mut self, led: &mut AllLed<'_>, placement: &Placement) {
        for (number, led) in led.iter_mut().take(MAX_FINGERS).enumerate() {
            let mut era = None;
            if let Some(Led {
                collider,
                goal,
                presence,
            }) = led
            {
                let goes = collider.go(goal) && *presence > 0.0;
                let now = Some(collider.era());
                // Set down within another body it would come out at any side.
                if goes && (now == self.eras[number] || self.is_clear(collider, placement)) {
                    era = now;
                } else if collider.felt().is_ok() {
                    collider.clear();
                }
            }
            if self.eras[number].is_some() && self.eras[number] != era {
                self.pile
                    .let_go(|against| against == Against::Finger(number));
            }
            self.eras[number] = era;
        }
    }

    /// Whether a tool is clear of all bodies but the touched one.
    fn is_clear(&self, collider: &Collider, placement: &Placement) -> bool {
        let Some(pose) = collider.pose().map(|pose| placement.pose_to_world(pose)) else {
            return false;
        };
        (self.pile.members[TOUCHED + 1..].iter()).all(|member| {
            let pose = member.placement.to_body(&pose);
            is_outside(member.touchable.of(true).0, collider.tool(), &pose)
        })
    }

    /// Has a tool keep what it felt, where it was in this tick; `before` is where the touched body was.
    fn feel(&mut self, number: usize, collider: &mut Collider, before: &Placement, pose: &Pose) {
        let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        let (mut pushed, mut stuck) = (0.0, 0.0);
        let mut felt = Felt {
            exact: true,
            ..Felt::default()
        };
        let mut nearest: Option<Slot> = None;
        collider.begin_taking();
        let modulus = self.pile.members[TOUCHED].young_modulus;
        let own = |contact: &&Contact| contact.against == Against::Finger(number);
        for contact in self.pile.contacts().iter().filter(own) {
            let member = &self.pile.members[contact.body];
            let slot = &member.slots()[member.slot(contact.point)];
            let on_body = before.direction_to_body(contact.force());
            let slot = Slot {
                tool: number as u8,
                body: TOUCHED as u8,
                force: on_body / modulus,
                push: contact.push / modulus,
                seen: (contact.gap, before.direction_to_body(contact.normal)),
                ..*slot
            };
            let is_touched = contact.body == TOUCHED;
            if is_touched && nearest.is_none_or(|other| slot.seen.0 < other.seen.0) {
                nearest = Some(slot);
            }
            if contact.push <= 0.0 {
                continue;
            }
            force -= contact.force();
            torque -= (member.place(contact.point) - pose.position).cross(contact.force());
            pushed += contact.push;
            if contact.anchor.is_some() && !contact.slips {
                stuck += contact.push;
            }
            felt.energy += self.held_by(contact);
            felt.pressed += 1;
            if is_touched {
                collider.take(slot);
            }
        }
        felt.force = before.direction_to_body(force);
        felt.torque = before.direction_to_body(torque);
        if felt.pressed > 0 {
            let share = if collider.rubs() { stuck / pushed } else { 0.0 };
            let turn = DMat3::from_quat(before.rotation.inverse());
            let stiffness = with_stuck(self.stiffness(number), share);
            felt.stiffness = turn * stiffness * turn.transpose();
            felt.own_energy = self.own_energy(number);
        }
        if let (Some(side), Some(slot)) = (collider.side_mut(TOUCHED), &nearest) {
            side.carried = slot.moved;
        }
        if collider.feel(felt, [nearest.as_ref(), None, None, None]) {
            self.pile
                .let_go(|against| against == Against::Finger(number));
        }
    }

    /// What a contact holds in its bodies and in the spring before it, where what it meets is now, J.
    fn held_by(&self, contact: &Contact) -> f64 {
        if contact.push <= 0.0 {
            return 0.0;
        }
        let moved = |body: usize| {
            let member = &self.pile.members[body];
            let shares = contact.shares_on(body).iter();
            let moved: DVec3 = shares
                .map(|&(point, share)| member.moved(point) * share)
                .sum();
            member.placement.rotation * moved * contact.sign_on(body)
        };
        let elastic = moved(contact.body) + contact.other().map_or(DVec3::ZERO, moved);
        let spring = contact.spring * contact.push;
        // What has just gone beyond an edge meets nothing any more.
        let is_met = contact.gap.is_finite();
        let off = if is_met { contact.gap + spring } else { 0.0 };
        0.5 * (contact.force().dot(elastic) + spring * contact.push) - off * contact.push
    }

    /// How a finger's contacts resist it, N/m, in the world.
    fn stiffness(&mut self, finger: usize) -> DMat3 {
        let Pile {
            contacts, solver, ..
        } = &mut self.pile;
        let chosen = &solver.chosen;
        solver.problem.stiffness(|unknown| {
            let contact = &contacts[chosen[unknown]];
            (contact.against == Against::Finger(finger)).then_some(contact.normal)
        })
    }

    /// What the pushes of a finger put into bodies and springs, were nobody else there, J.
    fn own_energy(&self, finger: usize) -> f64 {
        let solver = &self.pile.solver;
        let mut pushes = [0.0; crate::algebra::MOST_POINTS];
        for (push, &number) in pushes.iter_mut().zip(&solver.chosen) {
            let contact = &self.pile.contacts[number];
            if contact.against == Against::Finger(finger) {
                *push = contact.push;
            }
        }
        solver.problem.energy_of(&pushes[..solver.chosen.len()])
    }
}

/// A tool as the pile sees it in a tick.
fn rigid_of<'a>(led: &'a Led<'_>, placement: &Placement) -> Option<Rigid<'a>> {
    let posed = led.collider.posed()?;
    Some(Rigid {
        tool: led.collider.tool(),
        pose: placement.pose_to_world(&posed.pose),
        friction: posed.friction,
        presence: led.presence,
        is_hand: true,
    })
}
