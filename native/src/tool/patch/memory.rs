//! Memory of a patch that was copied.

use super::Patch;
use crate::algebra::MOST_POINTS;

impl Patch {
    /// Takes all memory that it ever needs: a copy has no more than it uses.
    pub(crate) fn reserve(&mut self) {
        self.slots.reserve(MOST_POINTS - self.slots.len());
    }
}
