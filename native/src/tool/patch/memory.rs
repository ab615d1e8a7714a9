//! What a patch has room for, and lets go.

use super::Patch;
use crate::algebra::MOST_POINTS;
use crate::tool::slot::Slot;

impl Patch {
    /// Takes all memory that it ever needs: a copy has no more than it uses.
    pub(crate) fn reserve(&mut self) {
        self.slots.reserve(MOST_POINTS - self.slots.len());
    }

    /// Drops some.
    pub(crate) fn let_go(&mut self, goes: impl Fn(&Slot) -> bool) {
        for slot in (0..self.slots.len()).rev() {
            if goes(&self.slots[slot]) {
                self.leave(slot);
            }
        }
    }
}
