//! The newest STATE of a device, with the worst of all that came with it.

use crate::device::link::messages::DeviceState;

/// The newest STATE. A later one excuses nothing that an earlier one of the same tick said.
#[derive(Debug, Clone, Copy)]
pub(super) struct Newest {
    /// Place and time of the newest, flags and buttons of all of its tick.
    pub(super) state: DeviceState,
    /// The largest of its tick, and of all before it that the servo was not told, m/s.
    pub(super) speed: f64,
    came: f64,
    /// The servo was told: no fault stood in the way.
    pub(super) is_told: bool,
}

impl Newest {
    /// The STATE that came at `now` (s), after another one.
    pub(super) fn of(state: DeviceState, speed: f64, now: f64, before: Option<&Self>) -> Self {
        let mut newest = Self {
            state,
            speed,
            came: now,
            is_told: false,
        };
        if let Some(before) = before {
            let came_together = before.came == now;
            if came_together {
                newest.state.fault |= before.state.fault;
                newest.state.ready &= before.state.ready;
                newest.state.buttons |= before.state.buttons;
            }
            if came_together || !before.is_told {
                newest.speed = speed.max(before.speed);
            }
        }
        newest
    }
}
