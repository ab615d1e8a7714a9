//! How bodies that nobody holds move as a whole, from tick to tick.

use glam::DVec3;

use super::joint::{Beside, Joint};
use crate::contact::ground::Ground;
use crate::contact::mobility::Motion;
use crate::fingers::press::{Answers, Press, Presses, numbered};
use crate::tool::slot::Slot;

/// In the tick forces act on bodies as a whole where they did at the beginning of one of so many: to say
/// anew where takes half as long as all else without friction.
const ARMS_EVERY: u32 = 4;

impl Joint {
    /// How the body at a place of the list moved in the last tick; not at all where it is held.
    pub(super) fn motion(&self, body: usize) -> Motion {
        self.motions[body]
    }

    /// Takes over how bodies are to move in this tick.
    pub(super) fn set_moving(&mut self, grounds: &[Ground<'_>]) {
        let is_due = self.pace.is_unhurried() || self.ticks % ARMS_EVERY == 0;
        self.ticks = self.ticks.wrapping_add(1);
        for (body, before) in self.mobilities.iter_mut().enumerate() {
            let now = grounds.get(body).and_then(|ground| ground.mobility);
            let is_alike = match (&*before, &now) {
                (Some(before), Some(now)) => before.is_alike(now) && !is_due,
                (None, None) => true,
                _ => false,
            };
            if !is_alike {
                self.patch.move_otherwise(body as u8, [*before, now]);
            }
            *before = now;
        }
    }

    /// Finds how bodies move by what presses them.
    pub(super) fn find_motions(&mut self, grounds: &[Ground<'_>], beside: &Beside<'_>) {
        for body in 0..self.mobilities.len() {
            self.motions[body] = Motion::default();
            let (Some(mobility), Some(ground)) = (self.mobilities[body], grounds.get(body)) else {
                continue;
            };
            let slots = self.patch.slots().iter();
            let own = slots.filter(|slot| usize::from(slot.body) == body);
            let by_tools = own.map(|slot| (slot.arm, slot.force));
            let acts = |press: &Press| press.touches && usize::from(press.body) == body;
            let forces = beside.several.forces();
            let by_points = numbered(beside.presses)
                .filter(|(_, press)| acts(press))
                .map(|(p, press)| {
                    (
                        ground.place(press.hold.triangle, press.hold.alpha),
                        forces[p],
                    )
                });
            self.motions[body] = mobility.motion(by_tools.chain(by_points));
        }
    }

    /// Sees the contact points from where their bodies have gone.
    pub(super) fn move_on(&mut self) {
        for slot in self.patch.slots_mut() {
            slot.moved -= self.motions[usize::from(slot.body)].at(slot.arm);
        }
    }

    /// How far a contact point is moved in its body's frame, which has moved on by then, m.
    pub(super) fn moved_in_frame(&self, slot: &Slot) -> DVec3 {
        slot.moved - self.motions[usize::from(slot.body)].at(slot.arm)
    }

    /// Takes from what points hold in bodies what only moved these as a whole.
    pub(super) fn take_motions(
        &self,
        grounds: &[Ground<'_>],
        presses: &Presses,
        answers: &mut Answers,
    ) {
        for (p, press) in numbered(presses).filter(|(_, press)| press.touches) {
            let body = usize::from(press.body);
            if grounds[body].mobility.is_some() {
                let at = grounds[body].place(press.hold.triangle, press.hold.alpha);
                let answer = &mut answers[p];
                answer.energy -= 0.5 * answer.force.dot(self.motions[body].at(at));
                answer.own_energy -= 0.5 * answer.force.dot(answer.along);
            }
        }
    }

    /// The elastic energy that tools hold in a body, J at unit modulus.
    pub(super) fn elastic(&self, body: usize) -> f64 {
        let slots = self.patch.slots().iter();
        let own = slots.filter(|slot| usize::from(slot.body) == body && slot.force != DVec3::ZERO);
        own.map(|slot| 0.5 * slot.force.dot(slot.moved)).sum()
    }
}
