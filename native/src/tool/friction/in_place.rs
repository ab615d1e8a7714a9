//! One sweep through many points, on the patch itself: a matrix of theirs would take longer to set up.

use glam::{DVec2, DVec3};

use super::{Rubbing, nearer, shortened};
use crate::tool::coefficients::AllPosed;
use crate::tool::patch::Patch;

impl Rubbing {
    /// Moves the slots as their forces ask for, and each rubbed point in turn nearer to its anchor; by how
    /// much its change moves one alone at most, about, m.
    pub(super) fn rub_in_place(&self, patch: &mut Patch, tools: &AllPosed) -> f64 {
        patch.begin_sum(|slot| slot.force, |slot| slot.offset);
        for number in 0..patch.slots().len() {
            patch.add(number);
        }
        patch.begin_changes();
        let (mut largest, mut rubbed) = (0.0_f64, self.rubbed.iter().peekable());
        for number in 0..patch.slots().len() {
            let moved = patch.see(number);
            let Some(&(_, directions, limit)) = rubbed.next_if(|&&(k, ..)| k == number) else {
                continue;
            };
            let slot = patch.slots()[number];
            let place = slot.at.position + moved;
            let stuck = slot.anchor.zip(tools[usize::from(slot.tool)]);
            let slip = place - stuck.map_or(place, |(anchor, tool)| tool.pose.to_body(anchor));
            let along = |vector: DVec3| DVec2::from_array(directions.map(|way| way.dot(vector)));
            let own = patch.compliance(number, number);
            let [first, second] = directions.map(|way| along(own * way));
            let last = along(slot.aside);
            let force = nearer(last, along(slip), [first.x, first.y, second.y], limit);
            largest = largest.max((force - last).abs().max_element() * (first.x + second.y));
            let aside = shortened(directions[0] * force.x + directions[1] * force.y, limit);
            patch.load(number, aside - slot.aside);
            let slot = &mut patch.slots_mut()[number];
            slot.aside = aside;
            slot.force = slot.normal * slot.push + aside;
        }
        patch.end_displacing();
        largest
    }
}
