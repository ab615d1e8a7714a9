//! Bodies that press each other, tick by tick.

use std::collections::BTreeSet;

use glam::{DMat3, DVec3};

use super::contact::{Against, Contact};
use super::meeting::{chosen, look, meet, share_out};
use super::member::Member;
use super::obstacle::Obstacle;
use super::rubbing::rub;
use super::system::System;
use crate::algebra::MOST_POINTS;
use crate::contact::mobility::{Mobility, Motion};
use crate::rest::resting::Restless;
use crate::tool::complementarity::Complementarity;

/// A force aside within this share of its limit slips.
const SLIPPING: f64 = 1.0 - 1e-7;

/// Bodies, and what they meet besides each other.
#[derive(Debug, Clone)]
pub struct Pile {
    /// By number.
    pub members: Vec<Member>,
    /// By number.
    pub obstacles: Vec<Obstacle>,
    /// In the world, m/s^2.
    pub gravity: DVec3,
    /// Coulomb's coefficient between bodies.
    pub friction: f64,
    contacts: Vec<Contact>,
    problem: Complementarity,
    system: System,
    /// Of the last solve, by unknown: forces, and how far contacts that rub are away by pushes alone.
    forces: Vec<f64>,
    slips: Vec<f64>,
    time: f64,
}

impl Pile {
    /// Bodies that touch nothing yet.
    pub fn new(
        members: Vec<Member>,
        obstacles: Vec<Obstacle>,
        gravity: DVec3,
        friction: f64,
    ) -> Self {
        Self {
            members,
            obstacles,
            gravity,
            friction,
            contacts: Vec::new(),
            problem: Complementarity::default(),
            system: System::default(),
            forces: Vec::new(),
            slips: Vec::new(),
            time: 0.0,
        }
    }

    /// Since the beginning, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// All contact points near anything; those that press have a push.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// One tick of `dt` s: how the bodies moved, each in its frame.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    pub fn tick(&mut self, dt: f64) -> Result<Vec<Motion>, Restless> {
        let stride = self.stride();
        for obstacle in &mut self.obstacles {
            obstacle.go(stride);
        }
        self.find_contacts();
        let mobilities: Vec<Option<Mobility>> = (self.members.iter())
            .map(|member| member.mobility(self.gravity, dt))
            .collect();
        self.solve(&mobilities);
        self.displace();
        let motions = self.move_on(&mobilities);
        self.look();
        self.take_anchors();
        self.time += dt;
        let is_finite = motions.iter().all(Motion::is_finite);
        let forces = self.contacts.iter().map(Contact::force);
        if is_finite && forces.into_iter().all(|force| force.is_finite()) {
            Ok(motions)
        } else {
            Err(Restless::NotANumber)
        }
    }

    /// How far an obstacle goes in a tick at most, m.
    fn stride(&self) -> f64 {
        0.5 * self.spacing()
    }

    /// The least distance between contact points, m.
    pub(super) fn spacing(&self) -> f64 {
        let spacings = self.members.iter().map(|member| member.surface.spacing());
        spacings.fold(f64::INFINITY, f64::min)
    }

    /// Contacts come and go, and those between bodies share their forces out where they are now.
    fn find_contacts(&mut self) {
        meet(&mut self.contacts, &self.members, &self.obstacles);
        // Between bodies, which have not moved since, the last tick has looked.
        let (members, obstacles) = (&self.members, &self.obstacles);
        let is_new = |contact: &&mut Contact| {
            contact.gap.is_infinite() || matches!(contact.against, Against::Obstacle(_))
        };
        (self.contacts.iter_mut().filter(is_new))
            .for_each(|contact| look(contact, members, obstacles));
        self.contacts.retain(|contact| contact.gap.is_finite());
        for contact in &mut self.contacts {
            share_out(contact, &self.members);
        }
        let points = self.fit();
        for (member, points) in self.members.iter_mut().zip(&points) {
            member.look_at(points);
        }
        self.displace();
        self.look();
    }

    /// Contact points of each body that are looked at. Contacts for which there is no room go, the
    /// farthest first.
    fn fit(&mut self) -> Vec<Vec<u32>> {
        let mut points = vec![BTreeSet::new(); self.members.len()];
        let mut ranked: Vec<usize> = (0..self.contacts.len()).collect();
        let rank = |&number: &usize| self.contacts[number].rank();
        ranked.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
        let mut fits = vec![false; self.contacts.len()];
        for number in ranked {
            let contact = &self.contacts[number];
            let loads = |body: usize| contact.shares_on(body).iter().map(|&(point, _)| point);
            fits[number] = points.iter().enumerate().all(|(body, points)| {
                let new = loads(body).filter(|point| !points.contains(point)).count();
                points.len() + new <= MOST_POINTS
            });
            if fits[number] {
                for (body, points) in points.iter_mut().enumerate() {
                    points.extend(loads(body));
                }
            }
        }
        let mut fits = fits.into_iter();
        self.contacts.retain(|_| fits.next() == Some(true));
        points
            .into_iter()
            .map(|points| points.into_iter().collect())
            .collect()
    }

    fn look(&mut self) {
        for contact in &mut self.contacts {
            look(contact, &self.members, &self.obstacles);
        }
    }

    /// Displaces all bodies by the contacts' forces.
    fn displace(&mut self) {
        for (body, member) in self.members.iter_mut().enumerate() {
            let turn = member.placement.rotation.inverse();
            let mut forces = vec![DVec3::ZERO; member.slots().len()];
            for contact in self.contacts.iter().filter(|contact| contact.push > 0.0) {
                let force = turn * contact.force() * contact.sign_on(body);
                for &(point, share) in contact.shares_on(body) {
                    forces[member.slot(point)] += force * share;
                }
            }
            member.load(&forces);
        }
    }

    /// Coulomb's coefficient of a contact, none before it has stuck.
    fn coefficient(&self, contact: &Contact) -> f64 {
        match (contact.anchor, contact.against) {
            (None, _) => 0.0,
            (_, Against::Obstacle(number)) => self.obstacles[number].friction,
            (_, Against::Body(_)) => self.friction,
        }
    }

    /// The frame of what a contact's point meets: its turn, and where a place of it is.
    fn turn_of(&self, against: Against) -> DMat3 {
        match against {
            Against::Obstacle(number) => self.obstacles[number].pose.rotation,
            Against::Body(number) => DMat3::from_quat(self.members[number].placement.rotation),
        }
    }

    /// Finds the forces of all contacts in this tick.
    fn solve(&mut self, mobilities: &[Option<Mobility>]) {
        let chosen = chosen(&self.contacts, &self.members);
        let away: Vec<DVec3> = (chosen.iter())
            .map(|&number| {
                let contact = &self.contacts[number];
                let (first, second) = contact.normal.any_orthonormal_pair();
                let slip = contact.anchor.map_or(DVec3::ZERO, |anchor| {
                    self.turn_of(contact.against) * (contact.place - anchor)
                });
                DVec3::new(contact.gap, first.dot(slip), second.dot(slip))
            })
            .collect();
        let limits: Vec<f64> = (chosen.iter())
            .map(|&number| self.coefficient(&self.contacts[number]))
            .collect();
        let (system, forces) = (&mut self.system, &mut self.forces);
        let rubs = (&away[..], |place: usize| limits[place] > 0.0);
        system.set_up(&self.contacts, &chosen, &self.members, mobilities, rubs);
        let friction: Vec<f64> = system.rubs.iter().map(|&place| limits[place]).collect();
        forces.clear();
        forces.extend(chosen.iter().map(|&number| self.contacts[number].push));
        forces.extend(system.rubs.iter().flat_map(|&place| {
            let aside = system.directions[place].transpose() * self.contacts[chosen[place]].aside;
            [aside.y, aside.z]
        }));
        rub(
            system,
            &mut self.problem,
            forces,
            &friction,
            &mut self.slips,
        );
        for contact in &mut self.contacts {
            (contact.push, contact.aside) = (0.0, DVec3::ZERO);
        }
        let (pushes, asides) = forces.split_at(chosen.len());
        for (&number, &push) in chosen.iter().zip(pushes) {
            self.contacts[number].push = push;
        }
        for (&place, aside) in system.rubs.iter().zip(asides.chunks_exact(2)) {
            let aside = DVec3::new(0.0, aside[0], aside[1]);
            self.contacts[chosen[place]].aside = system.directions[place] * aside;
        }
    }

    /// Bodies move as a whole by what presses them.
    fn move_on(&mut self, mobilities: &[Option<Mobility>]) -> Vec<Motion> {
        let mut motions = Vec::with_capacity(self.members.len());
        for (member, mobility) in self.members.iter_mut().zip(mobilities) {
            let Some(mobility) = mobility else {
                motions.push(Motion::default());
                continue;
            };
            let points = member.surface.points();
            let loads =
                (member.loads()).map(|(point, force)| (points[point as usize].position, force));
            let motion = mobility.motion(loads);
            if motion.is_finite() {
                member.placement = member.placement.moved(&motion);
            }
            motions.push(motion);
        }
        motions
    }

    /// Points that stuck keep their anchors, others have them where they are.
    fn take_anchors(&mut self) {
        for number in 0..self.contacts.len() {
            let limit = self.coefficient(&self.contacts[number]);
            let contact = &mut self.contacts[number];
            if contact.push <= 0.0 {
                (contact.anchor, contact.slips) = (None, false);
                continue;
            }
            let is_held = contact.anchor.is_some();
            contact.slips = is_held && contact.aside.length() >= SLIPPING * limit * contact.push;
            if !is_held || contact.slips {
                contact.anchor = Some(contact.place);
            }
        }
    }
}
