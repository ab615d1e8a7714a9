//! The contact of a finger in a tick.

use glam::DVec3;

use super::followed::Followed;
use crate::control::pressed::Pressed;
use crate::control::state::Findings;
use crate::device::Fault;
use crate::servo::snapshot::Snapshot;

/// A finger in a tick, with its contact.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// What is known of the tick, but for the output.
    pub(super) shot: Snapshot,
    pub(super) found: Findings,
    /// To go to the motors, N, but for the brake.
    pub(super) wanted: DVec3,
    /// What it pays, N.
    pub(super) brake: DVec3,
    /// For the toll.
    pub pressed: Pressed,
}

impl Touch {
    /// A contact that is shown so.
    pub(super) fn of(followed: &Followed<'_>, mut shot: Snapshot, wanted: DVec3) -> Self {
        let mut found = followed.found;
        (shot.touching, found.touching) = (true, true);
        Self {
            shot,
            found,
            wanted,
            brake: DVec3::ZERO,
            // Nobody knows of its energy, unless told.
            pressed: Pressed {
                is_unsettled: true,
                ..followed.free()
            },
        }
    }

    /// The same of a contact whose energy is known, and how much of it is its own force's.
    #[must_use]
    pub(super) fn with_energy(
        self,
        push: DVec3,
        (energy, own_energy): (f64, f64),
        is_settled: bool,
    ) -> Self {
        let pressed = Pressed {
            push,
            energy,
            own_energy,
            wanted: self.wanted,
            is_unsettled: !is_settled,
            ..self.pressed
        };
        Self { pressed, ..self }
    }

    /// The same with a brake, N.
    #[must_use]
    pub fn braked(self, brake: DVec3) -> Self {
        let shot = Snapshot {
            contact_force: self.shot.contact_force + brake,
            ..self.shot
        };
        Self {
            shot,
            brake,
            ..self
        }
    }

    /// Nothing is touched.
    pub(super) fn none(followed: &Followed<'_>) -> Self {
        Self {
            shot: followed.shot,
            found: followed.found,
            wanted: DVec3::ZERO,
            brake: DVec3::ZERO,
            pressed: followed.free(),
        }
    }

    /// The contact came out as no number.
    pub(super) fn nan(followed: &Followed<'_>) -> Self {
        let mut none = Self::none(followed);
        none.found.fault = none.found.fault.or(Some(Fault::Nan));
        none
    }
}
