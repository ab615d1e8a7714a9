//! The end of a guardian that was dismissed, or left to say the last word.

use std::process::Child;
use std::time::Duration;

/// Waits for a guardian that was dismissed, of [`PAUSE`] each: it looks twenty times a second.
const PAUSES: u32 = 100;
/// For one that is to speak: what a starved or suspended one has not said yet is worth the wait.
const PAUSES_TO_SPEAK: u32 = 1500;
const PAUSE: Duration = Duration::from_millis(2);

/// Waits for its end, and ends it where it does not come: it may have been stopped. A driver may keep it
/// longer than that.
pub(super) fn end(child: &mut Child, is_dismissed: bool) {
    let pauses = if is_dismissed {
        PAUSES
    } else {
        PAUSES_TO_SPEAK
    };
    if !ends(child, pauses) && child.kill().is_ok() {
        ends(child, PAUSES);
    }
}

fn ends(child: &mut Child, pauses: u32) -> bool {
    (0..pauses).any(|_| {
        let is_there = matches!(child.try_wait(), Ok(None));
        if is_there {
            std::thread::sleep(PAUSE);
        }
        !is_there
    })
}
