//! One sweep through many points, on the patch itself: a matrix of theirs would take longer to set up.

use glam::{DMat3, DVec2, DVec3};

use super::{Rubbing, nearer, shortened};
use crate::tool::coefficients::AllPosed;
use crate::tool::patch::Patch;

impl Rubbing {
    /// Moves the slots as their forces ask for, from where they are, and each rubbed point in turn
    /// nearer to its anchor; by how much its change of force moves one alone at most, about, m. What
    /// is behind a point in the turn has it find its anchor by the forces of before.
    pub(super) fn rub_in_place(&self, patch: &mut Patch, tools: &AllPosed) -> f64 {
        patch.begin_changes();
        let (mut largest, mut rubbed) = (0.0_f64, self.rubbed.iter().peekable());
        for number in 0..patch.slots().len() {
            let moved = patch.see(number);
            let slot = patch.slots()[number];
            let mut change = slot.force - slot.moved_by;
            if let Some(&(_, directions, limit)) = rubbed.next_if(|&&(k, ..)| k == number) {
                let own = patch.compliance(number, number);
                let place = slot.at.position + moved + own * change;
                let stuck = slot.anchor.zip(tools[usize::from(slot.tool)]);
                let slip = place - stuck.map_or(place, |(anchor, tool)| tool.pose.to_body(anchor));
                let aside = sheared(slot.aside, slip, &own, directions, limit);
                change += aside - slot.aside;
                let slot = &mut patch.slots_mut()[number];
                slot.aside = aside;
                slot.force = slot.normal * slot.push + aside;
            }
            largest = largest.max(change.abs().max_element() * slot.gives);
            patch.load(number, change);
        }
        patch.end_displacing();
        largest
    }
}

/// The force aside, within its limit, that brings a point nearer to its anchor.
#[inline]
fn sheared(last: DVec3, slip: DVec3, own: &DMat3, directions: [DVec3; 2], limit: f64) -> DVec3 {
    let along = |vector: DVec3| DVec2::from_array(directions.map(|way| way.dot(vector)));
    let [first, second] = directions.map(|way| along(*own * way));
    let force = nearer(
        along(last),
        along(slip),
        [first.x, first.y, second.y],
        limit,
    );
    shortened(directions[0] * force.x + directions[1] * force.y, limit)
}
