//! A system that stays, of contacts that lie nearly as they did.

use glam::DVec3;

use super::System;
use crate::algebra::cholesky::dot;
use crate::algebra::wide::add;
use crate::pile::contact::Contact;
use crate::pile::member::Member;
use crate::pile::solve::kept::bodies_of;

impl System {
    /// Finds where contacts are at rest from where they would be if all forces stayed.
    pub(super) fn stay(
        &mut self,
        (contacts, chosen): (&[Contact], &[usize]),
        members: &[Member],
        forces: &[f64],
    ) {
        let (pushes, count) = (chosen.len(), self.at_rest.len());
        self.driven.clear();
        self.driven.extend(members.iter().map(Member::driven));
        for (place, &number) in chosen.iter().enumerate() {
            let contact = &contacts[number];
            let mut moved = DVec3::ZERO;
            for body in bodies_of(contact).into_iter().flatten() {
                let member = &members[body];
                let by = self.driven[body].at(member.arm(contact.shares_on(body)));
                moved += member.placement.rotation * by * contact.sign_on(body);
            }
            self.add_away(place, self.directions[place].transpose() * moved);
        }
        let (push, asides) = forces.split_at(pushes);
        let (at_rest, at_rest_aside) = self.at_rest.split_at_mut(pushes);
        for (row, at_rest) in at_rest.iter_mut().enumerate() {
            *at_rest -= dot(&self.matrix[row * count..][..pushes], push);
        }
        for (number, (at_rest_aside, force)) in at_rest_aside.iter_mut().zip(asides).enumerate() {
            let row = &self.matrix[(pushes + number) * count..][..count];
            *at_rest_aside -= dot(row, forces);
            if *force != 0.0 {
                add(-force, &row[..pushes], at_rest);
            }
        }
    }
}
