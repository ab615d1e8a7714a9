//! Which contact points of a tool on a body a tick looks at.

use glam::DVec3;

use super::joint::{AllLed, Beside, Joint, Led, MOST_ENTERING};
use crate::body::closest::closest_point;
use crate::contact::ground::Ground;
use crate::fingers::press::Press;
use crate::tool::collider::side::Side;
use crate::tool::shape::{Pose, Tool};

/// Points within so many spacings of the tool are looked at.
pub(super) const MARGIN: f64 = 1.0;
/// Points beyond this many margins, at rest and now, are forgotten.
const FORGOTTEN: f64 = 1.5;
/// Once so many blocks of the compliance had to be fetched in a tick, further points wait.
const MOST_FETCHED: usize = 256;
/// Points that may enter in one tick times those that are looked at, whose response to each of them
/// is reckoned.
const MOST_RESPONSES: usize = 2000;
/// Points of a tool on a body that may take the place of farther ones in one tick, and by which share of the margin they
/// are nearer: which of two is nearer turns to and fro where both are about to be touched.
const MOST_REPLACED: usize = 2;
const NEARER: f64 = 0.5;
/// Points that may be let go in one tick.
const MOST_LEAVING: usize = 24;

impl Joint {
    /// Lets points of a tool on a body go that are far, and those near come in, nearest first; whether
    /// all of them are.
    pub(super) fn choose(
        &mut self,
        pair: [u8; 2],
        grounds: &[Ground<'_>],
        led: &mut AllLed<'_>,
        beside: &Beside<'_>,
    ) -> bool {
        let [tool, body] = pair.map(usize::from);
        let Some(collider) = led[tool].as_ref().map(|led| &*led.collider) else {
            return true;
        };
        let (Some(pose), Some(side)) = (collider.pose().copied(), collider.side(body)) else {
            return true;
        };
        self.let_leave(pair, collider.tool(), side, &pose);
        let carried = self.carried(pair, grounds, led, beside, &pose);
        let Some(collider) = led[tool].as_mut().map(|led| &mut *led.collider) else {
            return true;
        };
        if let Some(side) = collider.side_mut(body) {
            side.carried = carried;
            side.marks.begin();
            for slot in self.patch.slots().iter().filter(|slot| slot.is_of(pair)) {
                side.marks.set(slot.point);
            }
        }
        let Some(side) = collider.side(body) else {
            return true;
        };
        self.offer(pair, collider.tool(), side, &pose);
        self.rank(pair, collider.tool(), side, &pose);
        self.let_in(pair, collider.tool(), side, &pose, grounds, beside)
    }

    /// Lets points go that are far.
    fn let_leave(&mut self, pair: [u8; 2], tool: &Tool, side: &Side, pose: &Pose) {
        let limit = FORGOTTEN * MARGIN * side.surface().spacing();
        let mut left = 0;
        for place in (0..self.patch.slots().len()).rev() {
            let slot = &mut self.patch.slots_mut()[place];
            if !slot.is_of(pair) {
                continue;
            }
            let rest = slot.at.position;
            slot.free = tool.distance(pose.to_tool(rest + slot.moved));
            let is_gone = slot.force == DVec3::ZERO && slot.free.0 > limit && left < MOST_LEAVING;
            if is_gone && self.nearest_elsewhere(place, tool, side, pose) > limit {
                self.patch.leave(place);
                left += 1;
            }
        }
        self.effort.left += left;
    }

    /// Points near the tool that are not looked at yet, nearest first.
    fn offer(&mut self, pair: [u8; 2], tool: &Tool, side: &Side, pose: &Pose) {
        let surface = side.surface();
        let margin = MARGIN * surface.spacing();
        self.entering.clear();
        let (points, patch) = (surface.points(), &self.patch);
        let entering = &mut self.entering;
        let mut offer = |point: u32, moved: DVec3| {
            if side.marks.has(point) {
                return;
            }
            let place = points[point as usize].position + moved;
            let (distance, _) = tool.distance(pose.to_tool(place));
            if distance <= margin {
                insert(entering, distance, point);
            }
        };
        surface.tree().visit(
            |middle, radius| tool.least_distance(pose.to_tool(middle)) <= margin + radius,
            |point| offer(point, DVec3::ZERO),
        );
        if side.carried != DVec3::ZERO {
            let back = pose.moved(-side.carried);
            surface.tree().visit(
                |middle, radius| tool.least_distance(back.to_tool(middle)) <= margin + radius,
                |point| offer(point, side.carried),
            );
        }
        // Deep in the body the tool is past where the points were at rest: they come in from the side.
        for slot in patch.slots() {
            if slot.is_of(pair) && slot.force != DVec3::ZERO {
                for &other in surface.neighbours(slot.point) {
                    offer(other, slot.moved);
                }
            }
        }
    }

    /// Points go as far back among those that enter as they are if moved like any neighbour that is
    /// looked at: one that only seems near would take the place of another again and again.
    fn rank(&mut self, pair: [u8; 2], tool: &Tool, side: &Side, pose: &Pose) {
        let (surface, patch) = (side.surface(), &self.patch);
        for (distance, point) in &mut self.entering {
            let position = surface.points()[*point as usize].position;
            for &other in surface.neighbours(*point) {
                if let Some(other) = patch.slot(pair, other) {
                    let place = pose.to_tool(position + other.moved);
                    *distance = distance.max(tool.distance(place).0);
                }
            }
        }
        self.entering.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    }

    /// Takes in what was offered; whether it was all there is.
    fn let_in(
        &mut self,
        pair: [u8; 2],
        tool: &Tool,
        side: &Side,
        pose: &Pose,
        grounds: &[Ground<'_>],
        beside: &Beside<'_>,
    ) -> bool {
        let [number, body] = pair.map(usize::from);
        let first = self.patch.fetched();
        let (mut entered, mut replaced) = (0, 0);
        let kin = self.kin[body][number];
        for place in 0..self.entering.len() {
            let (distance, point) = self.entering[place];
            let reckoned = entered * self.patch.slots().len();
            if self.patch.fetched() - first > MOST_FETCHED || reckoned > MOST_RESPONSES {
                return false;
            }
            if let Err(among) = self.has_room(pair[0], 1) {
                let beyond = distance + NEARER * MARGIN * side.surface().spacing();
                if replaced == MOST_REPLACED || !self.make_room(beyond, among) {
                    return false;
                }
                replaced += 1;
            }
            (self.patch).enter(&grounds[body], side.surface(), pair, point, &kin);
            let new = self.patch.slots().len() - 1;
            self.offset_one(new, grounds, beside);
            let moved = self.patch.slots()[new].offset + self.patch.moved_of(new, |_| true);
            let slot = &mut self.patch.slots_mut()[new];
            slot.moved = moved;
            slot.free = tool.distance(pose.to_tool(slot.at.position + moved));
            entered += 1;
            self.effort.entered += 1;
        }
        self.effort.fetched += self.patch.fetched() - first;
        self.entering.len() < MOST_ENTERING
    }

    /// How far others move the surface that is nearest to the tool as they have moved it, m. Where no
    /// point is looked at, the surface under the tool is found from tick to tick: by where it was
    /// carried in the last one.
    fn carried(
        &mut self,
        pair: [u8; 2],
        grounds: &[Ground<'_>],
        led: &AllLed<'_>,
        beside: &Beside<'_>,
        pose: &Pose,
    ) -> DVec3 {
        let [number, body] = pair.map(usize::from);
        let others = |other: usize| other != number;
        let acts = |(other, led): (usize, &Option<Led<'_>>)| {
            others(other)
                && (led.as_ref()).is_some_and(|led| !led.collider.nodal_forces(body).is_empty())
        };
        let presses = |press: &Press| usize::from(press.body) == body;
        let remembers = !beside.memories[body].is_empty();
        if !(led.iter().enumerate().any(acts)
            || beside.presses.iter().flatten().any(presses)
            || remembers)
        {
            return DVec3::ZERO;
        }
        let slots = self.patch.slots().iter().enumerate();
        let own = slots.filter(|(_, slot)| slot.is_of(pair));
        if let Some((nearest, slot)) = own.min_by(|a, b| a.1.free.0.total_cmp(&b.1.free.0)) {
            // Its own forces are fewer than the others'.
            return slot.moved - self.patch.moved_of(nearest, |slot| slot.tool == pair[0]);
        }
        let Some(collider) = led[number].as_ref().map(|led| &*led.collider) else {
            return DVec3::ZERO;
        };
        let carried = collider.side(body).map_or(DVec3::ZERO, |side| side.carried);
        let middle = pose.position + pose.rotation * collider.tool().middle() - carried;
        let ground = (body, &grounds[body]);
        let (closest, _) = closest_point(ground.1.body, middle, 0);
        let nodes = ground.1.body.triangles[closest.triangle as usize];
        self.moved_by_tools(ground, led, nodes, closest.alpha, others)
            + self.moved_by_points(ground, beside, nodes, closest.alpha)
            + self.moved_by_memory(ground, beside.memories, nodes, closest.alpha)[1]
    }

    /// How near a point would be to the tool where it is offered from: at rest, carried by others, or
    /// moved like a pressed neighbour. One that was let go for being farther would come back at once.
    fn nearest_elsewhere(&self, place: usize, tool: &Tool, side: &Side, pose: &Pose) -> f64 {
        let slot = &self.patch.slots()[place];
        let moved_by = |moved: DVec3| tool.distance(pose.to_tool(slot.at.position + moved)).0;
        let mut nearest = moved_by(DVec3::ZERO);
        if side.carried != DVec3::ZERO {
            nearest = nearest.min(moved_by(side.carried));
        }
        for &other in side.surface().neighbours(slot.point) {
            let other = self.patch.slot([slot.tool, slot.body], other);
            if let Some(other) = other.filter(|other| other.force != DVec3::ZERO) {
                nearest = nearest.min(moved_by(other.moved));
            }
        }
        nearest
    }

    /// Whether there is room for some more points of a tool.
    ///
    /// # Errors
    /// The tool among whose points room is to be made; none for all.
    fn has_room(&self, number: u8, more: usize) -> Result<(), Option<u8>> {
        let slots = self.patch.slots();
        if slots.iter().filter(|slot| slot.tool == number).count() + more > self.pace.of_one {
            return Err(Some(number));
        }
        if slots.len() + more > self.pace.of_all {
            return Err(None);
        }
        Ok(())
    }

    /// Drops the farthest point without force, if it is farther than told.
    fn make_room(&mut self, distance: f64, among: Option<u8>) -> bool {
        let mut farthest: Option<(f64, usize)> = None;
        for (number, slot) in self.patch.slots().iter().enumerate() {
            let near = slot.free.0;
            let counts = slot.force == DVec3::ZERO && among.is_none_or(|tool| tool == slot.tool);
            if counts && near > farthest.map_or(distance, |(d, _)| d) {
                farthest = Some((near, number));
            }
        }
        farthest
            .map(|(_, number)| self.patch.leave(number))
            .is_some()
    }
}

/// Keeps the nearest points, nearest first; one that was offered from several places by the farthest.
fn insert(entering: &mut Vec<(f64, u32)>, distance: f64, point: u32) {
    let mut distance = distance;
    if let Some(before) = entering.iter().position(|&(_, other)| other == point) {
        distance = distance.max(entering.remove(before).0);
    }
    let place = entering.partition_point(|&(d, _)| d <= distance);
    if place < MOST_ENTERING {
        entering.insert(place, (distance, point));
        entering.truncate(MOST_ENTERING);
    }
}
