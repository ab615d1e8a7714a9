//! The newest answer of a board, with the worst of all that came with it.

use glam::DVec3;

use crate::device::haply::pantograph::Pose;

/// Where the newest answer says that the handle is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Newest {
    pub(super) position: DVec3,
    /// None where the arms cannot be.
    pub(super) pose: Option<Pose>,
    pub(super) speed: f64,
    /// The arms cannot be there, or not be held there, by this answer or by one that came with it.
    pub(super) is_impossible: bool,
    pub(super) is_stretched: bool,
    pub(super) came: f64,
    /// The servo was told of it: no fault stood in the way.
    pub(super) is_told: bool,
}

impl Newest {
    /// This answer, which excuses nothing that one before it said in the same tick.
    pub(super) fn after(mut self, before: &Self) -> Self {
        let came_together = self.came == before.came;
        if came_together {
            self.is_impossible |= before.is_impossible;
            self.is_stretched |= before.is_stretched;
        }
        if came_together || !before.is_told {
            self.speed = self.speed.max(before.speed);
        }
        self
    }
}
