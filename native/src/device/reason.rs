//! Reasons shown beside a state.

use super::Fault;

/// Waiting: nobody has answered.
pub const NO_ANSWER: &str = "no sound answer to HELLO yet";
/// Waiting: greeted, but no position yet.
pub const NO_STATE: &str = "no STATE yet";
/// Waiting: the device says that it would not obey.
pub const NOT_READY: &str = "the device is not ready";
/// Waiting: no hAPI board has answered.
pub const NO_BOARD: &str = "no answer from a hAPI board yet";
/// Waiting: a board is told what it has on which port.
pub const SETTING_UP: &str = "the board is being set up";
/// Waiting: a board was reset and its angles have no zero.
pub const LOST_PLACE: &str = "the board has forgotten where its handle is: \
    put the handle in its rest pose and start again";
/// Waiting: set up, but no position yet.
pub const NO_ANGLES: &str = "no angles yet";
/// Waiting: near its limit the device's force has no certain direction.
pub const STRETCHED: &str = "the arms are stretched: bring the handle back to the middle";
/// Waiting: a tool is made for one body, and there is another now.
pub const OTHER_BODY: &str = "its tool was made for another body: set it again";
/// Waiting: among others that the body presses, a point is not felt.
pub const ONLY_TOOLS: &str = "the body lies among others, which only tools press: set a tool";
/// Ramping: the thread has just started.
pub const STARTED: &str = "started";
/// Ramping: the device has just become ready.
pub const READY: &str = "device ready";
/// Ramping: the user has switched the force on again.
pub const SWITCHED_ON: &str = "switched on";
/// Ramping: the device's button was let go.
pub const RELEASED: &str = "button released";
/// Ramping: there is another body now.
pub const BODY_REPLACED: &str = "body replaced";
/// Free: set down inside of the body, which is not felt before the probe was outside.
pub const INSIDE: &str = "inside the body";
/// Disabled by the user.
pub const SWITCHED_OFF: &str = "switched off";
/// Disabled by the device's button.
pub const BUTTON: &str = "device button";
/// Stopped: never started.
pub const NOT_STARTED: &str = "not started";
/// Stopped by whoever started it.
pub const ASKED: &str = "asked to stop";

/// All of them but the empty one and those of [`after`].
pub const ALL: [&str; 20] = [
    NO_ANSWER,
    NO_STATE,
    NOT_READY,
    NO_BOARD,
    SETTING_UP,
    LOST_PLACE,
    NO_ANGLES,
    STRETCHED,
    OTHER_BODY,
    ONLY_TOOLS,
    STARTED,
    READY,
    SWITCHED_ON,
    RELEASED,
    BODY_REPLACED,
    INSIDE,
    SWITCHED_OFF,
    BUTTON,
    NOT_STARTED,
    ASKED,
];

/// The reason of a ramp that follows a fault.
pub const fn after(fault: Fault) -> &'static str {
    match fault {
        Fault::Nan => "after nan",
        Fault::TooFast => "after too fast",
        Fault::Stale => "after stale",
        Fault::Deaf => "after deaf",
        Fault::Unplugged => "after unplugged",
        Fault::Protocol => "after wrong protocol",
        Fault::Device => "after device fault",
        Fault::Suspended => "after suspended",
        Fault::Unguarded => "after unguarded",
        Fault::Internal => "after internal error",
    }
}
