//! Which contact points of which bodies are near what.

use std::collections::HashSet;

use glam::DVec3;

use super::contact::{Against, Contact};
use super::member::Member;
use super::obstacle::Obstacle;
use super::outline::met;
use super::shares::shares;
use crate::algebra::MOST_POINTS;

/// Points within so many distances between them are looked at.
const MARGIN: f64 = 0.5;
/// And forgotten beyond so many of these.
const FORGOTTEN: f64 = 1.5;
/// Contacts beyond this share of it are only watched.
const WATCHED: f64 = 0.15;
/// A place so many distances between points beyond an edge meets nothing.
const BESIDE: f64 = 0.25;

/// Of two bodies the one whose points meet the other's surface: the one with the finer points, the
/// first of two alike.
fn finer(members: &[Member], first: usize, second: usize) -> [usize; 2] {
    let [a, b] = [first, second].map(|body| members[body].surface.spacing());
    if b < a * (1.0 - 1e-9) {
        [second, first]
    } else {
        [first, second]
    }
}

/// A point of a body and what it is near to.
type Near = (usize, u32, Against);

/// Has contacts come that are near, and go that are far.
pub(super) fn meet(contacts: &mut Vec<Contact>, members: &[Member], obstacles: &[Obstacle]) {
    let mut found: Vec<Near> = Vec::new();
    let stays = |contact: &Contact| {
        let margin = FORGOTTEN * MARGIN * members[contact.body].surface.spacing();
        contact.push > 0.0 || contact.gap <= margin
    };
    // Those that stay need not be found.
    let staying: HashSet<Near> = (contacts.iter().filter(|contact| stays(contact)))
        .map(|contact| (contact.body, contact.point, contact.against))
        .collect();
    for body in 0..members.len() {
        for number in 0..obstacles.len() {
            near_obstacle(&mut found, members, body, obstacles, number);
        }
        for other in body + 1..members.len() {
            let [body, other] = finer(members, body, other);
            if members[body].free.is_some() || members[other].free.is_some() {
                near_body(&mut found, members, [body, other], &staying);
            }
        }
    }
    let mut missing: HashSet<Near> = found.iter().copied().collect();
    contacts.retain(|contact| {
        let is_found = missing.remove(&(contact.body, contact.point, contact.against));
        is_found || stays(contact)
    });
    // In the order in which they were found: what is reckoned does not depend on a table's.
    let new = found.into_iter().filter(|near| missing.contains(near));
    contacts.extend(new.map(|(body, point, against)| Contact::new(body, point, against)));
}

fn near_obstacle(
    found: &mut Vec<Near>,
    members: &[Member],
    body: usize,
    obstacles: &[Obstacle],
    number: usize,
) {
    let member = &members[body];
    let tool = &obstacles[number].tool;
    let pose = member.placement.to_body(&obstacles[number].pose);
    let margin = MARGIN * member.surface.spacing();
    let is_near =
        |middle: DVec3, radius| tool.least_distance(pose.to_tool(middle)) <= margin + radius;
    member.surface.tree().visit(is_near, |point| {
        let at = member.surface.points()[point as usize].position;
        if tool.distance(pose.to_tool(at)).0 <= margin {
            found.push((body, point, Against::Obstacle(number)));
        }
    });
}

fn near_body(
    found: &mut Vec<Near>,
    members: &[Member],
    [body, other]: [usize; 2],
    staying: &HashSet<Near>,
) {
    let (member, against) = (&members[body], &members[other]);
    let margin = MARGIN * member.surface.spacing();
    let beside = BESIDE * member.surface.spacing();
    let (middle, reach) = against.around;
    let middle = member
        .placement
        .place_to_body(against.placement.to_world(middle));
    if middle.distance(member.around.0) > reach + member.around.1 + margin {
        return;
    }
    let is_near = |ball: DVec3, radius| ball.distance(middle) <= reach + radius + margin;
    let mut triangle = 0;
    member.surface.tree().visit(is_near, |point| {
        let at = &member.surface.points()[point as usize];
        let place = (against.placement).place_to_body(member.placement.to_world(at.position));
        let is_known = staying.contains(&(body, point, Against::Body(other)));
        if is_known || !against.is_around(place, margin) {
            return;
        }
        let facing = member.placement.rotation * at.normal;
        let facing = against.placement.direction_to_body(facing);
        if let Some(near) = met(against.body(), place, facing, triangle, beside) {
            triangle = near.triangle;
            if near.gap <= margin {
                found.push((body, point, Against::Body(other)));
            }
        }
    });
}

/// Finds where a contact's point is on what it meets, how far from it and which way out.
pub(super) fn look(contact: &mut Contact, members: &[Member], obstacles: &[Obstacle]) {
    let member = &members[contact.body];
    let place = member.place(contact.point);
    match contact.against {
        Against::Obstacle(number) => {
            let Obstacle { tool, pose, .. } = &obstacles[number];
            contact.place = pose.to_tool(place);
            let (gap, normal) = tool.distance(contact.place);
            (contact.gap, contact.normal) = (gap, pose.rotation * normal);
        }
        Against::Body(number) => {
            let other = &members[number];
            let given = contact.shares.iter();
            let given: DVec3 = given
                .map(|&(point, share)| other.moved(point) * share)
                .sum();
            let at = &member.surface.points()[contact.point as usize];
            let facing = member.placement.rotation * at.normal;
            let facing = other.placement.direction_to_body(facing);
            contact.place = other.placement.place_to_body(place) - given;
            let beside = BESIDE * member.surface.spacing();
            match met(
                other.body(),
                contact.place,
                facing,
                contact.triangle,
                beside,
            ) {
                Some(met) => {
                    (contact.gap, contact.triangle) = (met.gap, met.triangle);
                    contact.normal = other.placement.rotation * met.normal;
                }
                None => contact.gap = f64::INFINITY,
            }
        }
    }
}

/// Contacts that may press in this tick: those that do, and the nearest others.
pub(super) fn chosen(contacts: &[Contact], members: &[Member]) -> Vec<usize> {
    let is_near = |contact: &Contact| {
        let watched = WATCHED * members[contact.body].surface.spacing();
        contact.gap.is_finite() && (contact.push > 0.0 || contact.gap <= watched)
    };
    let near = contacts.iter().enumerate().filter(|near| is_near(near.1));
    let mut chosen: Vec<usize> = near.map(|(number, _)| number).collect();
    if chosen.len() > MOST_POINTS {
        let rank = |&number: &usize| contacts[number].rank();
        chosen.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
        chosen.truncate(MOST_POINTS);
        chosen.sort_unstable();
    }
    chosen
}

/// Shares the force of a contact out anew, where its point is on the other body now.
pub(super) fn share_out(contact: &mut Contact, members: &[Member]) {
    if let Against::Body(number) = contact.against {
        let other = &members[number];
        let normal = other.placement.direction_to_body(contact.normal);
        contact.shares = shares(&other.surface, contact.place, normal);
    }
}
