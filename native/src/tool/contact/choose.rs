//! Which contact points a tick looks at.

use glam::DVec3;

use super::{MOST_ENTERING, ToolContact};
use crate::algebra::MOST_POINTS;
use crate::tool::shape::Pose;

/// Points within so many spacings of the tool are looked at.
pub(super) const MARGIN: f64 = 1.0;
/// Points beyond this many margins, at rest and now, are forgotten.
const FORGOTTEN: f64 = 1.5;
/// Once so many blocks of the compliance had to be fetched in a tick, further points wait.
const MOST_FETCHED: usize = 256;
/// Points that may enter in one tick times those that are looked at, whose response to each of them
/// is reckoned.
const MOST_RESPONSES: usize = 2000;
/// Points that may take the place of farther ones in one tick: which of two is nearer turns to and fro
/// where both are about to be touched.
const MOST_REPLACED: usize = 4;
/// Points that may be let go in one tick.
const MOST_LEAVING: usize = 24;

impl ToolContact {
    /// Lets points go that are far, and those near come in, nearest first; whether all of them are.
    pub(super) fn choose(
        &mut self,
        pose: &Pose,
        outside: &[(u32, DVec3)],
        young_modulus: f64,
    ) -> bool {
        let margin = MARGIN * self.surface.spacing();
        let could_fill = self.patch.slots().len() + MOST_ENTERING > MOST_POINTS;
        for number in (0..self.patch.slots().len()).rev() {
            let tool = &self.tool;
            let rest = self.patch.point(&self.surface, number).position;
            let slot = &mut self.patch.slots_mut()[number];
            slot.free = tool.distance(pose.to_tool(rest + slot.moved));
            slot.nearest = slot.free.0;
            if slot.force != DVec3::ZERO {
                continue;
            }
            let is_gone = slot.nearest > FORGOTTEN * margin;
            if is_gone || could_fill {
                let at_rest = tool.distance(pose.to_tool(rest)).0;
                slot.nearest = slot.nearest.min(at_rest);
            }
            let is_far = is_gone && slot.nearest > FORGOTTEN * margin;
            let may_leave = self.effort.left < MOST_LEAVING;
            if is_far && may_leave && !self.is_beside_pressed(number, pose) {
                self.patch.leave(number);
                self.effort.left += 1;
            }
        }
        self.carried = self.carried_by(pose, outside, young_modulus);
        let (tool, carried) = (&self.tool, self.carried);
        self.entering.clear();
        let (points, patch) = (self.surface.points(), &self.patch);
        let entering = &mut self.entering;
        let mut offer = |point: u32, moved: DVec3| {
            if patch.has(point) {
                return;
            }
            let place = points[point as usize].position + moved;
            let (distance, _) = tool.distance(pose.to_tool(place));
            if distance <= margin {
                insert(entering, distance, point);
            }
        };
        self.surface.tree().visit(
            |middle, radius| tool.least_distance(pose.to_tool(middle)) <= margin + radius,
            |point| offer(point, DVec3::ZERO),
        );
        if carried != DVec3::ZERO {
            let back = pose.moved(-carried);
            self.surface.tree().visit(
                |middle, radius| tool.least_distance(back.to_tool(middle)) <= margin + radius,
                |point| offer(point, carried),
            );
        }
        // Deep in the body the tool is past where the points were at rest: they come in from the side.
        for slot in patch.slots() {
            if slot.force != DVec3::ZERO {
                for &other in self.surface.neighbours(slot.point) {
                    offer(other, slot.moved);
                }
            }
        }
        let first = self.patch.fetched();
        let mut replaced = 0;
        for place in 0..self.entering.len() {
            let (distance, point) = self.entering[place];
            let reckoned = self.effort.entered * self.patch.slots().len();
            if self.patch.fetched() - first > MOST_FETCHED || reckoned > MOST_RESPONSES {
                return false;
            }
            if self.patch.is_full() {
                if replaced == MOST_REPLACED || !self.make_room(distance) {
                    return false;
                }
                replaced += 1;
            }
            self.patch.enter(&self.surface, point);
            let number = self.patch.slots().len() - 1;
            self.patch.slots_mut()[number].offset = self.offset_of(number, outside, young_modulus);
            self.patch.displace_one(number);
            self.look_at(number, pose);
            self.effort.entered += 1;
            self.effort.fetched = self.patch.fetched() - first;
        }
        self.entering.len() < MOST_ENTERING
    }

    /// Whether a point would be near the tool if it went where a pressed neighbour went.
    fn is_beside_pressed(&self, number: usize, pose: &Pose) -> bool {
        let slot = &self.patch.slots()[number];
        let rest = self.patch.point(&self.surface, number).position;
        let limit = FORGOTTEN * MARGIN * self.surface.spacing();
        let mut others = self.surface.neighbours(slot.point).iter();
        others.any(|&other| {
            self.patch.slot(other).is_some_and(|other| {
                let place = pose.to_tool(rest + other.moved);
                other.force != DVec3::ZERO && self.tool.distance(place).0 <= limit
            })
        })
    }

    /// Drops the farthest point without force, if it is farther than told.
    fn make_room(&mut self, distance: f64) -> bool {
        let mut farthest: Option<(f64, usize)> = None;
        for (number, slot) in self.patch.slots().iter().enumerate() {
            let near = slot.nearest;
            if slot.force == DVec3::ZERO && near > farthest.map_or(distance, |(d, _)| d) {
                farthest = Some((near, number));
            }
        }
        farthest
            .map(|(_, number)| self.patch.leave(number))
            .is_some()
    }
}

/// Keeps the nearest points, nearest first.
fn insert(entering: &mut Vec<(f64, u32)>, distance: f64, point: u32) {
    if entering.iter().any(|&(_, other)| other == point) {
        return;
    }
    let place = entering.partition_point(|&(d, _)| d <= distance);
    if place < MOST_ENTERING {
        entering.insert(place, (distance, point));
        entering.truncate(MOST_ENTERING);
    }
}
