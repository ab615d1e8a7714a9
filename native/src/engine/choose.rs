//! Which contact points of a tool a tick looks at.

use glam::DVec3;

use super::joint::{AllLed, Beside, Ground, Joint, Led, MOST_ENTERING};
use crate::algebra::MOST_POINTS;
use crate::body::closest::closest_point;
use crate::tool::collider::{Collider, MOST_NEAR};
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

impl Joint {
    /// Lets points of a tool go that are far, and those near come in, nearest first; whether all of
    /// them are.
    pub(super) fn choose(
        &mut self,
        number: u8,
        ground: &Ground<'_>,
        led: &mut AllLed<'_>,
        beside: &Beside<'_>,
    ) -> bool {
        let Some(pose) = led[usize::from(number)]
            .as_ref()
            .and_then(|led| led.collider.pose().copied())
        else {
            return true;
        };
        if let Some(led) = &led[usize::from(number)] {
            self.let_leave(number, led.collider, &pose);
        }
        let carried = self.carried(number, ground, led, beside, &pose);
        let Some(led) = &mut led[usize::from(number)] else {
            return true;
        };
        led.collider.carried = carried;
        led.collider.marks.begin();
        for slot in self.patch.slots().iter().filter(|slot| slot.tool == number) {
            led.collider.marks.set(slot.point);
        }
        self.offer(number, led.collider, &pose);
        self.let_in(number, led.collider, &pose, ground, beside)
    }

    /// Lets points go that are far.
    fn let_leave(&mut self, number: u8, collider: &Collider, pose: &Pose) {
        let (tool, margin) = (collider.tool(), MARGIN * collider.surface().spacing());
        let could_fill = self.has_room(number, MOST_ENTERING).is_err();
        let mut left = 0;
        for place in (0..self.patch.slots().len()).rev() {
            let slot = &mut self.patch.slots_mut()[place];
            if slot.tool != number {
                continue;
            }
            let rest = slot.at.position;
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
            if is_far && left < MOST_LEAVING && !self.is_beside_pressed(place, collider, pose) {
                self.patch.leave(place);
                left += 1;
            }
        }
        self.effort.left += left;
    }

    /// Points near the tool that are not looked at yet, nearest first.
    fn offer(&mut self, number: u8, collider: &Collider, pose: &Pose) {
        let (tool, surface) = (collider.tool(), collider.surface());
        let margin = MARGIN * surface.spacing();
        self.entering.clear();
        let (points, patch) = (surface.points(), &self.patch);
        let entering = &mut self.entering;
        let mut offer = |point: u32, moved: DVec3| {
            if collider.marks.has(point) {
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
        if collider.carried != DVec3::ZERO {
            let back = pose.moved(-collider.carried);
            surface.tree().visit(
                |middle, radius| tool.least_distance(back.to_tool(middle)) <= margin + radius,
                |point| offer(point, collider.carried),
            );
        }
        // Deep in the body the tool is past where the points were at rest: they come in from the side.
        for slot in patch.slots() {
            if slot.tool == number && slot.force != DVec3::ZERO {
                for &other in surface.neighbours(slot.point) {
                    offer(other, slot.moved);
                }
            }
        }
    }

    /// Takes in what was offered; whether it was all there is.
    fn let_in(
        &mut self,
        number: u8,
        collider: &Collider,
        pose: &Pose,
        ground: &Ground<'_>,
        beside: &Beside<'_>,
    ) -> bool {
        let first = self.patch.fetched();
        let (mut entered, mut replaced) = (0, 0);
        let kin = self.kin[usize::from(number)];
        for place in 0..self.entering.len() {
            let (distance, point) = self.entering[place];
            let reckoned = entered * self.patch.slots().len();
            if self.patch.fetched() - first > MOST_FETCHED || reckoned > MOST_RESPONSES {
                return false;
            }
            if let Err(among) = self.has_room(number, 1) {
                if replaced == MOST_REPLACED || !self.make_room(distance, among) {
                    return false;
                }
                replaced += 1;
            }
            self.patch.enter(collider.surface(), number, point, &kin);
            let new = self.patch.slots().len() - 1;
            self.offset_one(new, ground, beside);
            let moved = self.patch.slots()[new].offset + self.patch.moved_of(new, |_| true);
            let slot = &mut self.patch.slots_mut()[new];
            slot.moved = moved;
            slot.free = collider
                .tool()
                .distance(pose.to_tool(slot.at.position + moved));
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
        number: u8,
        ground: &Ground<'_>,
        led: &AllLed<'_>,
        beside: &Beside<'_>,
        pose: &Pose,
    ) -> DVec3 {
        let others = |other: usize| other != usize::from(number);
        let acts = |(other, led): (usize, &Option<Led<'_>>)| {
            others(other)
                && (led.as_ref()).is_some_and(|led| !led.collider.nodal_forces().is_empty())
        };
        if !(led.iter().enumerate().any(acts) || beside.presses.iter().any(Option::is_some)) {
            return DVec3::ZERO;
        }
        let slots = self.patch.slots().iter().enumerate();
        let own = slots.filter(|(_, slot)| slot.tool == number);
        if let Some((nearest, slot)) = own.min_by(|a, b| a.1.free.0.total_cmp(&b.1.free.0)) {
            return slot.offset + self.patch.moved_of(nearest, |slot| slot.tool != number);
        }
        let Some(led_tool) = &led[usize::from(number)] else {
            return DVec3::ZERO;
        };
        let collider = &*led_tool.collider;
        let middle = pose.position + pose.rotation * collider.tool().middle() - collider.carried;
        let (closest, _) = closest_point(ground.body, middle, 0);
        let nodes = ground.body.triangles[closest.triangle as usize];
        self.moved_by_tools(ground.body, led, nodes, closest.alpha, others)
            + self.moved_by_points(ground.body, beside, nodes, closest.alpha)
    }

    /// Whether a point would be near the tool if it went where a pressed neighbour went.
    fn is_beside_pressed(&self, place: usize, collider: &Collider, pose: &Pose) -> bool {
        let slot = &self.patch.slots()[place];
        let surface = collider.surface();
        let limit = FORGOTTEN * MARGIN * surface.spacing();
        let mut others = surface.neighbours(slot.point).iter();
        others.any(|&other| {
            self.patch.slot(slot.tool, other).is_some_and(|other| {
                let place = pose.to_tool(slot.at.position + other.moved);
                other.force != DVec3::ZERO && collider.tool().distance(place).0 <= limit
            })
        })
    }

    /// Whether there is room for some more points of a tool.
    ///
    /// # Errors
    /// The tool among whose points room is to be made; none for all.
    fn has_room(&self, number: u8, more: usize) -> Result<(), Option<u8>> {
        let slots = self.patch.slots();
        if slots.iter().filter(|slot| slot.tool == number).count() + more > MOST_NEAR {
            return Err(Some(number));
        }
        if slots.len() + more > MOST_POINTS {
            return Err(None);
        }
        Ok(())
    }

    /// Drops the farthest point without force, if it is farther than told.
    fn make_room(&mut self, distance: f64, among: Option<u8>) -> bool {
        let mut farthest: Option<(f64, usize)> = None;
        for (number, slot) in self.patch.slots().iter().enumerate() {
            let near = slot.nearest;
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
