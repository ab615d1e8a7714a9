//! A pile as what comes to rest.

use glam::DVec3;

use super::contact::{Against, Contact};
use super::obstacle::Obstacle;
use super::piled::Pile;
use crate::rest::placement::Placement;
use crate::rest::resting::Restless;
use crate::rest::settling::Settles;

/// Ticks are so long at most that a force takes a body as a whole so many times as far as it presses in
/// what it acts on; with friction, which is found in sweeps, less.
const LONGEST: f64 = 100.0;
const LONGEST_RUBBING: f64 = 2.0;

impl Settles for Pile {
    fn go(&mut self, dt: f64) -> Result<f64, Restless> {
        self.tick(dt)?;
        Ok(self.members.iter().fold(0.0_f64, |most, member| {
            most.max(member.motion.most(member.body().size()))
        }))
    }

    fn longest_tick(&self) -> f64 {
        let rubs = self.friction > 0.0 || self.obstacles.iter().any(|o| o.friction > 0.0);
        let times = if rubs { LONGEST_RUBBING } else { LONGEST };
        let own = self.members.iter().filter_map(|member| {
            let free = member.free?;
            Some(times * member.gives() * free.mass / free.drag_time)
        });
        own.fold(f64::INFINITY, f64::min).min(1.0)
    }

    /// Of all pairs that touch.
    fn forces(&self) -> Vec<DVec3> {
        let bodies = self.members.len();
        let others = self.obstacles.len() + bodies;
        let mut totals = vec![DVec3::ZERO; bodies * others];
        for contact in self.contacts() {
            let other = match contact.against {
                Against::Finger(_) => continue,
                Against::Obstacle(number) => number,
                Against::Body(number) => self.obstacles.len() + number,
            };
            totals[contact.body * others + other] += contact.force();
        }
        totals
    }

    fn weight(&self) -> f64 {
        let free = self.members.iter().filter_map(|member| member.free);
        let heaviest = free.fold(0.0_f64, |most, free| most.max(free.mass));
        heaviest * self.gravity.length()
    }

    fn left(&self) -> f64 {
        let mut most = 0.0_f64;
        for (body, member) in self.members.iter().enumerate() {
            let Some(free) = member.free else { continue };
            let gravity = member.placement.direction_to_body(self.gravity);
            let (mut force, mut torque) = (gravity * free.mass, DVec3::ZERO);
            let turn = member.placement.rotation.inverse();
            let presses = |contact: &&Contact| contact.push > 0.0;
            for contact in self.contacts().iter().filter(presses) {
                let own = turn * contact.force() * contact.sign_on(body);
                for &(point, share) in contact.shares_on(body) {
                    let at = member.slots()[member.slot(point)].arm;
                    force += own * share;
                    torque += (at - free.centre).cross(own * share);
                }
            }
            let (force, torque) = free.untaken(gravity, (force, torque));
            let size = member.body().size();
            most = most.max(force.length()).max(torque.length() / size);
        }
        most
    }

    fn is_led(&self, _share: f64) -> bool {
        self.obstacles.iter().all(Obstacle::is_there)
    }

    fn spacing(&self) -> f64 {
        Self::spacing(self)
    }

    /// Of the largest body.
    fn size(&self) -> f64 {
        let sizes = self.members.iter().map(|member| member.body().size());
        sizes.fold(0.0, f64::max)
    }

    fn since(&self) -> f64 {
        self.time()
    }

    fn placements(&self) -> Vec<Placement> {
        self.members.iter().map(|member| member.placement).collect()
    }

    fn mobility(&self) -> f64 {
        let free = self.members.iter().filter_map(|member| member.free);
        free.fold(0.0, |most, free| most.max(free.drag_time / free.mass))
    }
}
