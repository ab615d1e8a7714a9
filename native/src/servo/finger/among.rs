//! A finger among others, which move the surface under it: from tick to tick.

use glam::DVec3;

use crate::fingers::press::Answer;

/// What the others do at a finger's place.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Among {
    /// How far they moved the surface where it touches or will touch in the last tick, m.
    by_others: DVec3,
    /// How far it is moved back from its place before the proxy sees it, m: onto the rest surface.
    pub moved_back: DVec3,
    /// Unit vector of its push on the body, zero while it has none.
    push_direction: DVec3,
    /// Set down anew: what the others do there is not known yet.
    is_fresh: bool,
    /// That is known since the last tick: it decides on which side the finger was set down.
    pub set_down_again: bool,
}

impl Among {
    /// Just set down.
    pub fn fresh() -> Self {
        Self {
            is_fresh: true,
            ..Self::default()
        }
    }

    /// Whether it has to reckon with what others do or did.
    pub fn is_moved(&self) -> bool {
        self.by_others != DVec3::ZERO || self.moved_back != DVec3::ZERO
    }

    /// Carried along by the others. Across its push a finger holds the surface as it met it, unless the
    /// body may move as a whole: there its cone says what it holds.
    #[must_use]
    pub fn carried(self, is_held: bool) -> Self {
        let n = self.push_direction;
        let moved_back = if n == DVec3::ZERO || !is_held {
            self.by_others
        } else {
            self.moved_back + n * n.dot(self.by_others - self.moved_back)
        };
        Self { moved_back, ..self }
    }

    /// After a tick: what the others do now, and, if it presses by `displacement`, which way.
    #[must_use]
    pub fn after(self, answer: &Answer, touches: bool, displacement: Option<DVec3>) -> Self {
        let mut next = if answer.by_others.is_finite() {
            Self {
                by_others: answer.by_others,
                ..self
            }
        } else {
            Self::default()
        };
        next.set_down_again |= next.is_fresh && next.is_moved() && !touches;
        next.is_fresh = false;
        let Some(displacement) = displacement else {
            next.push_direction = DVec3::ZERO;
            return next;
        };
        let push = displacement - next.moved_back;
        let n = push.try_normalize().unwrap_or(next.push_direction);
        next.push_direction = n;
        let slipped = next.moved_back + answer.slip - n * n.dot(answer.slip);
        if slipped.is_finite() {
            next.moved_back = slipped;
        }
        next
    }
}
