//! Which contact points of which bodies are near what.

use std::collections::HashSet;

use glam::DVec3;

use super::contact::{Against, Contact};
use super::member::Member;
use super::obstacle::{Around, Rigid};
use super::outline::met;
use super::shares::shares;
use crate::algebra::hashing::Quick;

/// Points within so many distances between them are looked at.
const MARGIN: f64 = 0.5;
/// And forgotten beyond so many of these.
const FORGOTTEN: f64 = 1.5;
/// Contacts beyond this share of it are only watched.
const WATCHED: f64 = 0.15;
/// A place so many distances between points beyond an edge meets nothing.
const BESIDE: f64 = 0.25;
/// What is around a place is known for a way of this share of that.
const KNOWN: f64 = 0.0625;
/// Outside of a body nothing is met beyond so many times as far as it may be off and beyond an edge: the
/// curved surface, which it is near to, lies less than that beyond the triangles.
const FAR: f64 = 2.0;

/// Of two bodies the one whose points meet the other's surface: the one with the finer points, the
/// first of two alike.
fn finer(members: &[Member], first: usize, second: usize) -> [usize; 2] {
    let [a, b] = [first, second].map(|body| members[body].touchable.own().spacing());
    if b < a * (1.0 - 1e-9) {
        [second, first]
    } else {
        [first, second]
    }
}

/// Around an edge a push turns from one face to the next by so much at most, rad, each time that it is
/// looked at: what it has pressed aside would else spring back at once.
const MOST_TURN: f64 = 0.06;

/// A point of a body and what it is near to.
type Near = (usize, u32, Against);

/// Points that are found near anything in a tick at most.
pub(super) const MOST_FOUND: usize = 2048;
/// Contacts that there are at most.
pub(super) const MOST_CONTACTS: usize = 2 * MOST_FOUND;

/// Memory to find contacts in: as much as it ever needs.
#[derive(Debug, Clone)]
pub(super) struct Meeting {
    found: Vec<Near>,
    staying: HashSet<Near, Quick>,
    missing: HashSet<Near, Quick>,
}

impl Default for Meeting {
    fn default() -> Self {
        Self {
            found: Vec::with_capacity(MOST_FOUND),
            staying: HashSet::with_capacity_and_hasher(MOST_CONTACTS, Quick::default()),
            missing: HashSet::with_capacity_and_hasher(MOST_FOUND, Quick::default()),
        }
    }
}

impl Meeting {
    fn offer(&mut self, near: Near) {
        if self.found.len() < MOST_FOUND {
            self.found.push(near);
        }
    }

    /// Has contacts come that are near, and go that are far.
    pub(super) fn meet(
        &mut self,
        contacts: &mut Vec<Contact>,
        members: &[Member],
        around: &Around<'_>,
    ) {
        self.found.clear();
        let stays = |contact: &Contact| {
            let margin = MARGIN * members[contact.body].touchable.spacing(contact.point);
            let margin = FORGOTTEN * margin + went(contact, members);
            contact.push > 0.0 || contact.gap <= margin
        };
        // Those that stay need not be found.
        self.staying.clear();
        let staying = contacts.iter().filter(|contact| stays(contact));
        (self.staying).extend(staying.map(|told| (told.body, told.point, told.against)));
        for body in 0..members.len() {
            for (against, rigid) in around.all() {
                self.near_rigid(&members[body], (body, against), &rigid);
            }
            for other in body + 1..members.len() {
                let [body, other] = finer(members, body, other);
                if members[body].free.is_some() || members[other].free.is_some() {
                    self.near_body(members, [body, other]);
                }
            }
        }
        self.missing.clear();
        self.missing.extend(self.found.iter().copied());
        let missing = &mut self.missing;
        contacts.retain(|contact| {
            let is_found = missing.remove(&(contact.body, contact.point, contact.against));
            is_found || stays(contact)
        });
        // In the order in which they were found: what is reckoned does not depend on a table's.
        let new = self.found.iter().filter(|near| missing.contains(near));
        let new = new.map(|&(body, point, against)| Contact::new(body, point, against));
        let room = MOST_CONTACTS.saturating_sub(contacts.len());
        contacts.extend(new.take(room));
    }

    fn near_rigid(
        &mut self,
        member: &Member,
        (body, against): (usize, Against),
        rigid: &Rigid<'_>,
    ) {
        let pose = member.placement.to_body(&rigid.pose);
        let (surface, first) = member.touchable.of(rigid.is_hand);
        let margin = MARGIN * surface.spacing() + member.went();
        let is_near = |middle: DVec3, radius| {
            rigid.tool.least_distance(pose.to_tool(middle)) <= margin + radius
        };
        surface.tree().visit(is_near, |point| {
            let at = surface.points()[point as usize].position;
            if rigid.tool.distance(pose.to_tool(at)).0 <= margin {
                self.offer((body, first + point, against));
            }
        });
    }

    fn near_body(&mut self, members: &[Member], [body, other]: [usize; 2]) {
        let (member, against) = (&members[body], &members[other]);
        let margin = MARGIN * member.touchable.own().spacing() + member.went() + against.went();
        let beside = BESIDE * member.touchable.own().spacing();
        let (middle, reach) = against.around;
        let middle = member
            .placement
            .place_to_body(against.placement.to_world(middle));
        if middle.distance(member.around.0) > reach + member.around.1 + margin {
            return;
        }
        let is_near = |ball: DVec3, radius| ball.distance(middle) <= reach + radius + margin;
        let surface = against.surface();
        let mut triangle = 0;
        member.touchable.own().tree().visit(is_near, |point| {
            let at = &member.touchable.own().points()[point as usize];
            let place = (against.placement).place_to_body(member.placement.to_world(at.position));
            let is_known = self.staying.contains(&(body, point, Against::Body(other)));
            if is_known || !against.is_around(place, margin) {
                return;
            }
            let facing = member.placement.rotation * at.normal;
            let facing = against.placement.direction_to_body(facing);
            let is_outside = !against.is_around(place, 0.0);
            if is_outside && !surface.may_meet(place, facing, FAR * (margin + beside)) {
                return;
            }
            let closest = surface.closest(place, triangle);
            if let Some(near) = met(&surface, place, facing, &closest, beside) {
                triangle = near.triangle;
                if near.gap <= margin {
                    self.offer((body, point, Against::Body(other)));
                }
            }
        });
    }
}

/// How far its bodies went in the last tick at most, m, and so perhaps in this one towards each other.
#[inline]
fn went(contact: &Contact, members: &[Member]) -> f64 {
    let other = contact.other().map_or(0.0, |number| members[number].went());
    members[contact.body].went() + other
}

/// Finds where a contact's point is on what it meets, how far from it and which way out.
pub(super) fn look(contact: &mut Contact, members: &[Member], around: &Around<'_>) {
    let member = &members[contact.body];
    let place = member.place(contact.point);
    match contact.against {
        Against::Finger(_) | Against::Obstacle(_) => {
            let Some(Rigid { tool, pose, .. }) = around.of(contact.against) else {
                contact.gap = f64::INFINITY;
                return;
            };
            contact.place = pose.to_tool(place);
            let (gap, normal) = tool.distance(contact.place);
            (contact.gap, contact.normal) = (gap, pose.rotation * normal);
        }
        Against::Body(number) => {
            let other = &members[number];
            let surface = other.surface();
            let given = contact.shares.iter();
            let given: DVec3 = given
                .map(|&(point, share)| other.moved(point) * share)
                .sum();
            let at = member.touchable.point(contact.point);
            let facing = member.placement.rotation * at.normal;
            let facing = other.placement.direction_to_body(facing);
            contact.place = other.placement.place_to_body(place) - given;
            let beside = BESIDE * member.touchable.own().spacing();
            let way = KNOWN * beside;
            let closest =
                (contact.known).closest(surface.body, contact.place, contact.triangle, way);
            match met(&surface, contact.place, facing, &closest, beside) {
                Some(met) => {
                    let normal = other.placement.rotation * met.normal;
                    contact.normal = if contact.push > 0.0 {
                        turned(contact.normal, normal)
                    } else {
                        normal
                    };
                    contact.gap = met.gap * normal.dot(contact.normal) + contact.within;
                    (contact.triangle, contact.presence) = (met.triangle, met.presence);
                }
                None => contact.gap = f64::INFINITY,
            }
        }
    }
}

/// A direction turned towards another, by [`MOST_TURN`] at most.
fn turned(from: DVec3, to: DVec3) -> DVec3 {
    let angle = from.angle_between(to);
    if angle <= MOST_TURN {
        return to;
    }
    let across = (to - from * from.dot(to)).normalize_or(from.any_orthonormal_vector());
    from * MOST_TURN.cos() + across * MOST_TURN.sin()
}

/// Contacts that may press in this tick: those that do, and the nearest others, as many as there is
/// room for.
pub(super) fn choose(
    chosen: &mut Vec<usize>,
    contacts: &[Contact],
    members: &[Member],
    room: usize,
) {
    let is_near = |contact: &Contact| {
        let watched = WATCHED * members[contact.body].touchable.spacing(contact.point);
        let watched = watched + went(contact, members);
        contact.gap.is_finite() && (contact.push > 0.0 || contact.gap <= watched)
    };
    chosen.clear();
    let near = contacts.iter().enumerate().filter(|near| is_near(near.1));
    chosen.extend(near.map(|(number, _)| number));
    if chosen.len() > room {
        rank(chosen, contacts);
        chosen.truncate(room);
        chosen.sort_unstable();
    }
}

/// Puts contacts first that are to be kept first where there is no room for all.
pub(super) fn rank(numbers: &mut [usize], contacts: &[Contact]) {
    numbers.sort_unstable_by(|&a, &b| {
        let [first, second] = [a, b].map(|number| contacts[number].rank());
        first.total_cmp(&second).then(a.cmp(&b))
    });
}

/// Shares the force of a contact out anew, where its point is on the other body now.
pub(super) fn share_out(contact: &mut Contact, members: &[Member]) {
    if let Against::Body(number) = contact.against {
        let other = &members[number];
        let normal = other.placement.direction_to_body(contact.normal);
        let nearest = contact.shares.first().map(|share| share.0);
        contact.shares = shares(other.touchable.own(), contact.place, normal, nearest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_push_turns_around_an_edge_in_many_looks() {
        let mut normal = DVec3::Z;
        for look in 1..=26 {
            let before = normal;
            normal = turned(normal, DVec3::X);
            assert!(normal.is_normalized() && normal.dot(DVec3::Y).abs() < 1e-12);
            assert!(before.angle_between(normal) <= MOST_TURN + 1e-9, "{look}");
        }
        assert!(normal.distance(DVec3::X) < 0.02);
        assert_eq!(turned(normal, DVec3::X), DVec3::X);
    }
}
