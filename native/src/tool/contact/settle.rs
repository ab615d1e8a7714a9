//! The equilibrium of the contact points with the tool, within bounds on the work.

use glam::DVec3;

use super::ToolContact;
use super::choose::MARGIN;
use crate::algebra::MOST_POINTS;
use crate::tool::friction::across;
use crate::tool::shape::Pose;
use crate::tool::shape::tilt::Hold;

/// Linearisations in one tick.
const MOST_LINEARISATIONS: usize = 6;
/// Multiplications that a tick takes, about, before it leaves the rest to the next.
const MOST_WORK: usize = 500_000;
/// The same with friction.
const MOST_WORK_RUBBING: usize = 700_000;
/// Points farther from the tool than this share of the margin are only watched.
const WATCHED: f64 = 0.3;
/// Displacements that are wrong by less than this share of the tool's reach have been found.
const CONVERGED: f64 = 3e-6;

impl ToolContact {
    /// Finds the equilibrium of the points with the tool, from the last tick's forces on: how many
    /// linearisations it took, and whether it was found.
    pub(super) fn settle(&mut self, pose: &Pose) -> (usize, bool) {
        let limit = CONVERGED * self.tool.reach();
        let rubs = !self.friction.is_none();
        let most_work = if rubs { MOST_WORK_RUBBING } else { MOST_WORK };
        self.see(pose);
        for made in 1..=MOST_LINEARISATIONS {
            self.linearise();
            let before = self.effort.multiplications;
            // Forces aside take their share: pushes get no more with friction than without.
            let left = most_work.saturating_sub(before);
            self.problem.solve(left.min(MOST_WORK));
            self.push();
            let is_held = !rubs || {
                let (friction, reach) = (&self.friction, self.tool.reach());
                self.rubbing
                    .rub(&mut self.patch, &self.surface, pose, friction, reach)
            };
            if !rubs {
                self.patch.displace();
            }
            for number in 0..self.patch.slots().len() {
                self.look_at(number, pose);
            }
            let error = self.see(pose);
            self.count(rubs);
            if error <= limit && is_held {
                return (made, true);
            }
            // Another one takes as much again.
            let after = self.effort.multiplications;
            if after + (after - before) > most_work {
                return (made, false);
            }
        }
        (MOST_LINEARISATIONS, false)
    }

    /// Adds what a linearisation took.
    fn count(&mut self, rubs: bool) {
        let (chosen, near) = (self.chosen.len(), self.patch.slots().len());
        let effort = &mut self.effort;
        (effort.near, effort.chosen) = (near, chosen);
        effort.decompositions += self.problem.decompositions();
        effort.multiplications += self.problem.work() + near * self.tool.effort();
        effort.multiplications += chosen * (2 * chosen + 5 * near);
        effort.multiplications += if rubs {
            self.rubbing.work() + 9 * chosen * near
        } else {
            9 * chosen * near
        };
    }

    /// Distance and normal of the tool where a slot is now.
    #[inline]
    pub(super) fn look_at(&mut self, number: usize, pose: &Pose) {
        let rest = self.patch.point(&self.surface, number).position;
        let slot = &mut self.patch.slots_mut()[number];
        slot.free = self.tool.distance(pose.to_tool(rest + slot.moved));
    }

    /// Holds distances and normals as the pushes now ask for; by how much displacements are wrong
    /// with these at most, about, m: what the gaps are from zero, and what the forces turned along
    /// the new normals would move.
    fn see(&mut self, pose: &Pose) -> f64 {
        let points = self.surface.points();
        let watched = WATCHED * MARGIN * self.surface.spacing();
        let pushes = self.patch.slots().iter().map(|slot| {
            let facing = points[slot.point as usize].normal;
            (slot.push * slot.normal, facing)
        });
        let hold = Hold::of(pushes).map(|hold| hold.seen_from(&pose.rotation));
        let (mut gap, mut turned, mut gives) = (0.0_f64, 0.0, 0.0_f64);
        for slot in self.patch.slots_mut() {
            let point = &points[slot.point as usize];
            let (distance, normal) = hold.map_or(slot.free, |hold| {
                let place = pose.to_tool(point.position + slot.moved);
                // Which way a point would be pushed that is only watched is not asked.
                let is_watched = slot.push == 0.0 && slot.force == DVec3::ZERO;
                if is_watched && hold.is_beyond(watched, slot.free, place, &self.tool) {
                    return slot.free;
                }
                let facing = pose.rotation.transpose() * point.normal;
                hold.hold(slot.free, place, facing, &self.tool)
            });
            slot.seen = (distance, pose.rotation * normal);
            if slot.push > 0.0 {
                gap = gap.max(distance.abs());
                turned += slot.push * (slot.seen.1 - slot.normal).length();
                gives = gives.max(slot.gives);
            } else {
                gap = gap.max(-distance);
            }
        }
        gap + turned * gives
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
        }
    }

    /// The complementarity problem of the distances linearised about the displacements.
    fn linearise(&mut self) {
        self.chosen.clear();
        let watched = WATCHED * MARGIN * self.surface.spacing();
        let mut normals = [DVec3::ZERO; MOST_POINTS];
        for (number, slot) in self.patch.slots_mut().iter_mut().enumerate() {
            (slot.distance, slot.normal) = slot.seen;
            if slot.distance < watched || slot.force != DVec3::ZERO {
                let place = self.chosen.len();
                self.problem.forces[place] = slot.push;
                let given = slot.moved - slot.offset;
                self.problem.gaps[place] = slot.distance - slot.normal.dot(given);
                normals[place] = slot.normal;
                self.chosen.push(number);
            }
        }
        if !self.friction.is_none() {
            // What the forces aside move counts as given, like the other fingers'.
            for slot in self.patch.slots_mut() {
                slot.aside = across(slot.aside, slot.normal);
            }
        }
        self.problem.begin(self.chosen.len());
        self.patch.begin_sum();
        for (j, &loaded) in self.chosen.iter().enumerate() {
            self.patch.add(loaded, self.patch.slots()[loaded].aside);
            let [x, y, z] = self.patch.moved_by(loaded, normals[j]);
            for (i, &seen) in self.chosen.iter().enumerate().skip(j) {
                let moved = DVec3::new(x[seen], y[seen], z[seen]);
                self.problem.set(i, j, normals[i].dot(moved));
            }
        }
        if !self.friction.is_none() {
            let [x, y, z] = self.patch.sum();
            for (place, &number) in self.chosen.iter().enumerate() {
                let given = DVec3::new(x[number], y[number], z[number]);
                self.problem.gaps[place] += normals[place].dot(given);
            }
        }
    }
}
