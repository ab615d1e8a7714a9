//! The end of a guardian that was dismissed.

use std::process::Child;
use std::time::Duration;

/// Waits, of [`PAUSE`] each: it looks whether it was dismissed twenty times a second.
const PAUSES: u32 = 50;
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
