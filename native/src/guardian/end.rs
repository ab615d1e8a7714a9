//! The end of a guardian that was dismissed, or left to say the last word.

use std::process::Child;
use std::time::Duration;

/// Waits, of [`PAUSE`] each: it looks twenty times a second, and speaks for 70 ms at most.
const PAUSES: u32 = 100;
const PAUSE: Duration = Duration::from_millis(2);

/// Waits for its end, and ends it where it does not come: it may have been stopped. A driver may keep it
/// longer than that.
pub(super) fn end(child: &mut Child) {
    if !ends(child) && child.kill().is_ok() {
        ends(child);
    }
}

fn ends(child: &mut Child) -> bool {
    (0..PAUSES).any(|_| {
        let is_there = matches!(child.try_wait(), Ok(None));
        if is_there {
            std::thread::sleep(PAUSE);
        }
        !is_there
    })
}
