//! Forces of all contacts in a tick: one problem, set up, solved, and handed to the contacts.

mod kept;
mod mirrored;
pub(super) mod pace;
mod products;
mod rubbing;
mod straight;
mod system;

use glam::{DMat3, DVec3};

use super::contact::{Against, Contact};
use super::meeting::choose;
use super::member::Member;
use super::obstacle::Around;
use crate::contact::fading::fading;
use crate::tool::complementarity::Complementarity;
use pace::Pace;
use rubbing::{Rubbed, rub};
use system::System;

/// The problem of a tick, and the memory to solve it in.
#[derive(Debug, Clone, Default)]
pub(super) struct Solver {
    pub problem: Complementarity,
    system: System,
    /// Contacts that may press, by number, in the order of their unknowns.
    pub chosen: Vec<usize>,
    /// Their ways now, m: gap, and from where they stuck.
    away: Vec<DVec3>,
    limits: Vec<f64>,
    /// By how much more a contact gives way than its bodies do, as a share of that.
    fading: Vec<f64>,
    /// Coefficients of those that rub.
    friction: Vec<f64>,
    /// By unknown: forces, and how far contacts that rub are away by pushes alone.
    forces: Vec<f64>,
    slips: Vec<f64>,
}

/// What there is in a tick besides contacts and bodies.
pub(super) struct Given<'a> {
    pub around: Around<'a>,
    /// Coulomb's coefficient between bodies.
    pub friction: f64,
    pub pace: Pace,
}

impl Solver {
    /// Takes all memory that it ever needs for so many contacts of so many bodies.
    pub fn reserve(&mut self, contacts: usize, bodies: usize) {
        self.system.reserve(contacts, bodies);
        self.chosen.reserve(super::meeting::MOST_CONTACTS);
        for numbers in [&mut self.limits, &mut self.fading, &mut self.friction] {
            numbers.reserve(contacts);
        }
        for numbers in [&mut self.forces, &mut self.slips] {
            numbers.reserve(3 * contacts);
        }
        self.away.reserve(contacts);
    }

    /// Finds the forces of all contacts in this tick.
    pub fn solve(&mut self, contacts: &mut [Contact], members: &[Member], given: &Given<'_>) {
        let around = &given.around;
        choose(&mut self.chosen, contacts, members, given.pace.room);
        let chosen = &self.chosen;
        let turn_of = |against: Against| match against {
            Against::Body(number) => DMat3::from_quat(members[number].placement.rotation),
            rigid => (around.of(rigid)).map_or(DMat3::IDENTITY, |rigid| rigid.pose.rotation),
        };
        self.away.clear();
        self.away.extend(chosen.iter().map(|&number| {
            let contact = &contacts[number];
            let (first, second) = contact.normal.any_orthonormal_pair();
            let slip = contact.anchor.map_or(DVec3::ZERO, |anchor| {
                turn_of(contact.against) * (contact.place - anchor)
            });
            DVec3::new(contact.gap, first.dot(slip), second.dot(slip))
        }));
        self.limits.clear();
        let limit = |&number: &usize| around.coefficient(&contacts[number], given.friction);
        self.limits.extend(chosen.iter().map(limit));
        self.fading.clear();
        self.fading.extend(chosen.iter().map(|&number| {
            let contact = &contacts[number];
            let presence = around
                .of(contact.against)
                .map_or(contact.presence, |r| r.presence);
            fading(presence)
        }));
        let (system, forces, limits) = (&mut self.system, &mut self.forces, &self.limits);
        let rubs = (&self.away[..], |place: usize| limits[place] > 0.0);
        let told = (&*contacts, &chosen[..]);
        system.begin(told, rubs);
        self.friction.clear();
        self.friction
            .extend(system.rubs.iter().map(|&place| limits[place]));
        forces.clear();
        forces.extend(chosen.iter().map(|&number| contacts[number].push));
        forces.extend(system.rubs.iter().flat_map(|&place| {
            let aside = system.directions[place].transpose() * contacts[chosen[place]].aside;
            [aside.y, aside.z]
        }));
        system.set_up(told, members, (forces, given.pace.may_keep));
        system.find_springs(&self.fading);
        let rubbed = Rubbed {
            friction: &self.friction,
            pace: given.pace,
        };
        rub(system, &mut self.problem, forces, &rubbed, &mut self.slips);
        for contact in contacts.iter_mut() {
            (contact.push, contact.aside) = (0.0, DVec3::ZERO);
            (contact.spring, contact.fading) = (0.0, 0.0);
        }
        let (pushes, asides) = forces.split_at(chosen.len());
        for (place, &number) in chosen.iter().enumerate() {
            let contact = &mut contacts[number];
            contact.push = pushes[place];
            (contact.spring, contact.fading) = (system.springs[place], self.fading[place]);
        }
        for (&place, aside) in system.rubs.iter().zip(asides.chunks_exact(2)) {
            let aside = DVec3::new(0.0, aside[0], aside[1]);
            contacts[chosen[place]].aside = system.directions[place] * aside;
        }
    }
}
