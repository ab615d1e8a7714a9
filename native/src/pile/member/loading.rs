//! What presses a body of the pile, and how that gives way.

use glam::DVec3;

use super::Member;

impl Member {
    /// Begins to load it with the forces on it: none so far.
    pub(in crate::pile) fn begin_loading(&mut self) {
        let slots = self.patch.slots_mut().iter_mut();
        slots.for_each(|slot| slot.force = DVec3::ZERO);
    }

    /// Adds a force, N in its frame, shared out among points that are looked at.
    pub(in crate::pile) fn add_load(&mut self, shares: &[(u32, f64)], force: DVec3) {
        let force = force / self.young_modulus;
        for &(point, share) in shares {
            let slot = self.slot(point);
            self.patch.slots_mut()[slot].force += force * share;
        }
    }

    /// Displaces the slots by their loads.
    pub(in crate::pile) fn give_way(&mut self) {
        self.patch.displace();
    }

    /// The elastic energy in it, J.
    pub fn elastic(&self) -> f64 {
        let slots = self.slots().iter();
        let held = slots.map(|slot| 0.5 * slot.force.dot(slot.moved));
        held.sum::<f64>() * self.young_modulus
    }

    /// Forces on its contact points, N in its frame.
    pub fn loads(&self) -> impl Iterator<Item = (u32, DVec3)> {
        let slots = self.slots().iter();
        slots.map(|slot| (self.point_of(slot), slot.force * self.young_modulus))
    }
}
