//! Ticks of a pile, until all of it rests.

use glam::DVec3;

use super::contact::{Against, Contact};
use super::piled::Pile;
use crate::rest::resting::Restless;

/// Ticks are so long at most that a force takes a body as a whole so many times as far as it presses in
/// what it acts on; with friction, which is found in sweeps, less.
const LONGEST: f64 = 100.0;
const LONGEST_RUBBING: f64 = 2.0;
/// And this share of that at least.
const SHORTEST: f64 = 1e-3;
/// On the way to rest bodies move by this share of the distance between contact points in a tick, about.
const WAY_PER_SPACING: f64 = 0.25;
/// A pile rests when what is left of the wrenches on each body, and by how much forces still change, is
/// less than this share of the largest force.
const AT_REST: f64 = 1e-8;
/// In so many ticks one after the other.
const QUIET_TICKS: usize = 3;
/// Ticks that it is given, and how many times a body's size one may go meanwhile.
const MOST_TICKS: usize = 20_000;
const MOST_SIZES: f64 = 20.0;
/// After all of its ticks so much may be left: balls creep to where their meshes are softest.
const CREEPING: f64 = 1e-5;

impl Pile {
    /// Ticks until nothing changes any more.
    ///
    /// # Errors
    /// [`Restless`]; the bodies are where they came to.
    pub fn settle(&mut self) -> Result<(), Restless> {
        let (mut quiet, mut speed, mut gone, mut left) = (0, 0.0, 0.0, f64::INFINITY);
        let longest = self.longest_tick();
        let mut dt = SHORTEST * longest;
        let mut before = self.totals();
        for _ in 0..MOST_TICKS {
            let motions = self.tick(dt)?;
            let now = self.totals();
            let largest = self.largest(&now);
            left = self.left() / largest;
            let pairs = before.iter().zip(&now);
            let change = pairs.fold(0.0_f64, |most, (a, b)| most.max(a.distance(*b)));
            let is_quiet = self
                .obstacles
                .iter()
                .all(super::obstacle::Obstacle::is_there)
                && left <= AT_REST
                && change <= AT_REST * largest;
            quiet = if is_quiet { quiet + 1 } else { 0 };
            before = now;
            if quiet == QUIET_TICKS {
                return Ok(());
            }
            let ways = motions.iter().zip(&self.members);
            let way = ways.fold(0.0_f64, |most, (motion, member)| {
                most.max(motion.most(member.body().size()))
            });
            (speed, gone) = (way / dt, gone + way);
            if gone > MOST_SIZES * self.size() {
                break;
            }
            let most = (WAY_PER_SPACING * self.spacing() / way).clamp(0.1, 2.0);
            dt = (dt * most).clamp(SHORTEST * longest, longest);
        }
        if left <= CREEPING {
            return Ok(());
        }
        Err(Restless::Moving(self.time(), speed))
    }

    /// The longest tick in which contact is found, s.
    fn longest_tick(&self) -> f64 {
        let rubs = self.friction > 0.0 || self.obstacles.iter().any(|o| o.friction > 0.0);
        let times = if rubs { LONGEST_RUBBING } else { LONGEST };
        let own = self.members.iter().filter_map(|member| {
            let free = member.free?;
            Some(times * member.gives() * free.mass / free.drag_time)
        });
        own.fold(f64::INFINITY, f64::min).min(1.0)
    }

    /// Of the largest body, m.
    fn size(&self) -> f64 {
        let sizes = self.members.iter().map(|member| member.body().size());
        sizes.fold(0.0, f64::max)
    }

    /// Forces between all pairs that touch, N.
    fn totals(&self) -> Vec<DVec3> {
        let bodies = self.members.len();
        let others = self.obstacles.len() + bodies;
        let mut totals = vec![DVec3::ZERO; bodies * others];
        for contact in self.contacts() {
            let other = match contact.against {
                Against::Obstacle(number) => number,
                Against::Body(number) => self.obstacles.len() + number,
            };
            totals[contact.body * others + other] += contact.force();
        }
        totals
    }

    /// The largest of forces and weights, N.
    fn largest(&self, totals: &[DVec3]) -> f64 {
        let weights = self.members.iter().filter_map(|member| member.free);
        let weights = weights.map(|free| free.mass * self.gravity.length());
        let forces = totals.iter().map(|force| force.length());
        weights.chain(forces).fold(f64::MIN_POSITIVE, f64::max)
    }

    /// What is left of the wrenches on a free body at most, N; a torque by the body's size.
    fn left(&self) -> f64 {
        let mut most = 0.0_f64;
        for (body, member) in self.members.iter().enumerate() {
            let Some(free) = member.free else { continue };
            let points = member.surface.points();
            let (mut force, mut torque) = (
                member.placement.direction_to_body(self.gravity) * free.mass,
                DVec3::ZERO,
            );
            let turn = member.placement.rotation.inverse();
            let presses = |contact: &&Contact| contact.push > 0.0;
            for contact in self.contacts().iter().filter(presses) {
                let own = turn * contact.force() * contact.sign_on(body);
                for &(point, share) in contact.shares_on(body) {
                    let at = points[point as usize].position;
                    force += own * share;
                    torque += (at - free.centre).cross(own * share);
                }
            }
            let size = member.body().size();
            most = most.max(force.length()).max(torque.length() / size);
        }
        most
    }
}
