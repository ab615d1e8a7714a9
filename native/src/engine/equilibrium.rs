//! The equilibrium of the contact points with all tools, within bounds on the work.

use glam::DVec3;

use super::choose::MARGIN;
use super::joint::easing::Easing;
use super::joint::{AllLed, Beside, Joint, Led};
use crate::algebra::MOST_POINTS;
use crate::contact::fading::fading;
use crate::contact::ground::Ground;
use crate::tool::coefficients::AllPosed;
use crate::tool::collider::Collider;
use crate::tool::collider::side::Side;
use crate::tool::friction::across;
use crate::tool::shape::tilt::{Push, TiltLimit};
use crate::tool::slot::Slot;

/// Points farther from the tool than this share of the margin are only watched.
const WATCHED: f64 = 0.3;
/// Displacements that are wrong by less than this share of the tool's reach have been found.
const CONVERGED: f64 = 3e-6;
/// Where two tools press one point, each has a spring of this share of the point's own compliance: else
/// nothing would say which of them carries what.
const SHARING: f64 = 0.02;

/// How a body and its tools are seen.
#[derive(Clone, Copy)]
struct Seen {
    is_held: bool,
    /// As the tick begins.
    begins: bool,
}

impl Joint {
    /// Finds the equilibrium of the points with the tools, from the last tick's forces on: how many
    /// linearisations it took, and whether it was found.
    pub(super) fn settle(
        &mut self,
        grounds: &[Ground<'_>],
        led: &AllLed<'_>,
        posed: &AllPosed,
        beside: &mut Beside<'_>,
    ) -> (usize, bool) {
        let rubs = posed.iter().flatten().any(|tool| !tool.friction.is_none());
        let pace = self.pace;
        let most_work = if rubs { pace.work_rubbing } else { pace.work };
        self.easing = Easing::default();
        self.see(grounds, led, true);
        for made in 1..=pace.linearisations {
            self.linearise(led, rubs);
            let before = self.effort.multiplications;
            // Forces aside take their share: pushes get no more with friction than without.
            let left = most_work.saturating_sub(before).min(pace.work);
            self.problem.solve(left);
            let solved = self.problem.work();
            let meets = self.meet_points(grounds, beside, left);
            self.push();
            let is_held = !rubs || self.rubbing.rub(&mut self.patch, posed, pace.sweeping);
            if !rubs {
                self.patch.displace();
            }
            self.look(led);
            let error = self.see(grounds, led, false);
            self.count(solved, rubs, led);
            if error <= CONVERGED && is_held && meets {
                return (made, true);
            }
            // Another one takes as much again.
            let after = self.effort.multiplications;
            if after + (after - before) > most_work {
                return (made, false);
            }
            self.easing.learn(made, error);
        }
        (pace.linearisations, false)
    }

    /// Adds what a linearisation took.
    fn count(&mut self, solved: usize, rubs: bool, led: &AllLed<'_>) {
        let (chosen, near) = (self.chosen.len(), self.patch.slots().len());
        let effort = &mut self.effort;
        (effort.near, effort.chosen) = (near, chosen);
        effort.decompositions += self.problem.decompositions();
        effort.multiplications += solved;
        for slot in self.patch.slots() {
            let tool = led[usize::from(slot.tool)].as_ref();
            effort.multiplications += tool.map_or(0, |led| led.collider.tool().effort());
        }
        effort.multiplications += chosen * (2 * chosen + 5 * near);
        effort.multiplications += if rubs {
            self.rubbing.work() + 9 * chosen * near
        } else {
            9 * chosen * near
        };
    }

    /// Distances and normals of the tools where their slots are now.
    fn look(&mut self, led: &AllLed<'_>) {
        for slot in self.patch.slots_mut() {
            if let Some(Led { collider, .. }) = &led[usize::from(slot.tool)]
                && let Some(pose) = collider.pose()
            {
                let place = pose.to_tool(slot.at.position + slot.moved);
                slot.free = collider.tool().distance(place);
            }
        }
    }

    /// Holds distances and normals as the pushes now ask for; by which share of their tool's reach
    /// displacements are wrong with these at most, about. `begins`: with what was found in the tick before,
    /// since when bodies were moved by their weight, perhaps right through a tool.
    fn see(&mut self, grounds: &[Ground<'_>], led: &AllLed<'_>, begins: bool) -> f64 {
        let mut error = 0.0_f64;
        for (number, led) in led.iter().enumerate() {
            let Some(led) = led else { continue };
            for (body, ground) in grounds.iter().enumerate() {
                if let Some(side) = led.collider.side(body) {
                    let pair = [number as u8, body as u8];
                    let seen = Seen {
                        is_held: ground.mobility.is_none(),
                        begins,
                    };
                    error = error.max(self.see_one(pair, seen, led.collider, side));
                }
            }
        }
        error
    }

    /// The same for one tool on one body: what its gaps are from zero, and what its forces turned along the new
    /// normals would move.
    fn see_one(&mut self, pair: [u8; 2], seen: Seen, collider: &Collider, side: &Side) -> f64 {
        let tool = collider.tool();
        let Some(pose) = collider.pose() else {
            return 0.0;
        };
        let watched = WATCHED * MARGIN * side.surface().spacing();
        let own = |slot: &&Slot| slot.is_of(pair);
        let pushes = self.patch.slots().iter().filter(own);
        let pushes = pushes.map(|slot| Push {
            by: slot.push * slot.normal,
            free: if seen.begins {
                slot.normal
            } else {
                pose.rotation * slot.free.1
            },
            facing: slot.at.normal,
        });
        let hold = TiltLimit::of(pushes, seen.is_held);
        let hold = hold.filter(|_| !tool.is_endless());
        let hold = hold.map(|hold| hold.seen_from(&pose.rotation));
        let part = self.easing.part;
        let (mut gap, mut turned, mut gives) = (0.0_f64, 0.0, 0.0_f64);
        for slot in self.patch.slots_mut().iter_mut() {
            if !slot.is_of(pair) {
                continue;
            }
            let (distance, normal) = hold.map_or(slot.free, |hold| {
                let place = pose.to_tool(slot.at.position + slot.moved);
                // Which way a point would be pushed that is only watched is not asked.
                let is_watched = slot.push == 0.0 && slot.force == DVec3::ZERO;
                if is_watched && hold.is_beyond(watched, slot.free, place, tool) {
                    return slot.free;
                }
                let facing = pose.rotation.transpose() * slot.at.normal;
                hold.hold(slot.free, place, facing, tool)
            });
            slot.seen = (distance, pose.rotation * normal);
            if slot.push > 0.0 {
                gap = gap.max((distance + slot.spring * slot.push).abs());
                turned += slot.push * (slot.seen.1 - slot.normal).length();
                gives = gives.max(slot.gives);
            } else {
                gap = gap.max(-distance);
            }
            if part < 1.0 && slot.seen.1 != slot.normal {
                let eased = slot
                    .normal
                    .lerp(slot.seen.1, part)
                    .normalize_or(slot.seen.1);
                let place = pose.to_tool(slot.at.position + slot.moved);
                let along = pose.rotation.transpose() * eased;
                slot.seen = (tool.separation(place, along), eased);
            }
        }
        (gap + turned * gives) / tool.reach()
    }

    /// Forces of the slots along their normals, as the problem's solution has them.
    fn push(&mut self) {
        for slot in self.patch.slots_mut() {
            (slot.force, slot.push) = (DVec3::ZERO, 0.0);
        }
        for (place, &number) in self.chosen.iter().enumerate() {
            let slot = &mut self.patch.slots_mut()[number];
            slot.force = slot.normal * self.problem.forces[place];
            slot.push = slot.force.length();
            slot.spring += self.problem.growth(place);
        }
    }

    /// The complementarity problem of the distances linearised about the displacements.
    fn linearise(&mut self, led: &AllLed<'_>, rubs: bool) {
        self.chosen.clear();
        let mut normals = [[0.0; MOST_POINTS]; 3];
        for (number, slot) in self.patch.slots_mut().iter_mut().enumerate() {
            (slot.distance, slot.normal) = slot.seen;
            for (axis, along) in normals.iter_mut().zip(slot.normal.to_array()) {
                axis[number] = along;
            }
            if slot.distance < watched(led, [slot.tool, slot.body]) || slot.force != DVec3::ZERO {
                let place = self.chosen.len();
                self.problem.forces[place] = slot.push;
                let given = slot.moved - slot.offset;
                self.problem.gaps[place] = slot.distance - slot.normal.dot(given);
                self.chosen.push(number);
            }
        }
        if rubs {
            // What the forces aside move counts as given, like the points'.
            for slot in self.patch.slots_mut() {
                slot.aside = across(slot.aside, slot.normal);
            }
        }
        self.problem.begin(self.chosen.len());
        let mut asides = [[0.0; MOST_POINTS]; 3];
        let (mut along, mut by_asides) = ([0.0; MOST_POINTS], [0.0; MOST_POINTS]);
        for (i, &loaded) in self.chosen.iter().enumerate() {
            let Slot { normal, aside, .. } = self.patch.slots()[loaded];
            if rubs {
                let (ways, moved) = ([&normals, &asides], [&mut along, &mut by_asides]);
                by_asides[loaded] += self
                    .patch
                    .moved_by_both(loaded, [normal, aside], ways, moved);
                for (axis, number) in asides.iter_mut().zip(aside.to_array()) {
                    axis[loaded] = number;
                }
            } else {
                self.patch.moved_along(loaded, normal, &normals, &mut along);
            }
            for (j, &seen) in self.chosen[..=i].iter().enumerate() {
                self.problem.set(i, j, along[seen]);
            }
        }
        self.add_springs(led);
        if rubs {
            for (place, &number) in self.chosen.iter().enumerate() {
                self.problem.gaps[place] += by_asides[number];
            }
        }
    }

    /// What lies between a point and a tool that comes back gradually, or that shares it with another.
    fn add_springs(&mut self, led: &AllLed<'_>) {
        for (unknown, &place) in self.chosen.iter().enumerate() {
            let slot = self.patch.slots()[place];
            let presence = led[usize::from(slot.tool)]
                .as_ref()
                .map_or(1.0, |led| led.presence);
            let fading = fading(presence);
            let mut share = fading;
            for (other, _) in self.kin[usize::from(slot.body)][usize::from(slot.tool)]
                .iter()
                .enumerate()
                .filter(|k| *k.1)
            {
                let other = [other as u8, slot.body];
                if other[0] != slot.tool
                    && let Some(beside) = self.patch.slot(other, slot.point)
                {
                    // From nothing where the other tool is about to be looked at to all at its touch.
                    let near = 1.0 - beside.seen.0 / watched(led, other);
                    share += SHARING * near.clamp(0.0, 1.0);
                }
            }
            // How the body moves as a whole depends on the tick's length: what two tools share does not.
            let carried = self.mobilities[usize::from(slot.body)].map_or(0.0, |mobility| {
                (slot.normal).dot(mobility.between(slot.arm, slot.arm) * slot.normal)
            });
            let elastic = self.problem.own(unknown) - carried;
            let spring = share * elastic + fading * carried;
            self.patch.slots_mut()[place].spring = spring;
            self.problem
                .set(unknown, unknown, self.problem.own(unknown) + spring);
        }
    }
}

/// How far from a tool its points are only watched, m.
fn watched(led: &AllLed<'_>, [tool, body]: [u8; 2]) -> f64 {
    let side =
        (led[usize::from(tool)].as_ref()).and_then(|led| led.collider.side(usize::from(body)));
    side.map_or(0.0, |side| WATCHED * MARGIN * side.surface().spacing())
}
