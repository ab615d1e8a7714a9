//! The guardian: a program that says zero to a device when its host cannot any more.
//!
//! `build.rs` compiles this file and its parts alone, so it uses no crate; the library sees the [`Sheet`] by which the
//! two know of each other. The host gives it a line that breaks when the host ends (standard input), the
//! device's port (standard output) and the sheet (standard error), and nothing else. On Windows the line is
//! the host's process itself.

use std::sync::atomic::Ordering::{Acquire, Release, SeqCst};
use std::time::Duration;

#[path = "program/sheet.rs"]
mod sheet;
#[cfg(unix)]
#[path = "program/unix.rs"]
mod system;
#[cfg(windows)]
#[path = "program/windows.rs"]
mod system;

use sheet::Written;
pub use sheet::{DISMISSED, GUARDIAN, HOST, LEFT, MOST_BYTES, Sheet};
use system::{Port, handed_sheet, host_ends_within, leave_the_group};
pub use system::{map_sheet, now_ns};

/// A host that has given no sign of life for so long has stopped, ns: the zero that follows is there
/// within 20 ms, when a device's own watchdog would wait no longer either.
pub const SILENCE_NS: u64 = 12_000_000;
/// Times that it is said: one may be lost on the line.
const TIMES: u32 = 3;
const PAUSE: Duration = Duration::from_millis(2);
/// Tries to write, a pause each, on a line that is full.
const TRIES: u32 = 10;
/// Wait for a host that has not begun, or that was silenced, ms.
const IDLE_MS: u32 = 50;
const MS: u64 = 1_000_000;

fn last_word(sheet: &Sheet) -> ([u8; MOST_BYTES], usize) {
    let word = &sheet.words[sheet.newest.load(Acquire) as usize % 2];
    let length = (word.length.load(Acquire) as usize).min(MOST_BYTES);
    let mut bytes = [0; MOST_BYTES];
    for (byte, stored) in bytes.iter_mut().zip(&word.bytes) {
        *byte = stored.load(Acquire);
    }
    (bytes, length)
}

/// Says the last word instead of all that waits on the line, unless the host is back before that.
fn speak(port: &mut Port, sheet: &Sheet, host_may_come_back: bool) {
    let (bytes, length) = last_word(sheet);
    if length == 0 {
        return;
    }
    port.discard();
    for time in 0..TIMES {
        if time > 0 {
            std::thread::sleep(PAUSE);
        }
        if host_may_come_back && sheet.holder.load(SeqCst) != GUARDIAN {
            return;
        }
        write_all(port, &bytes[..length]);
    }
}

fn write_all(port: &mut Port, mut bytes: &[u8]) {
    for _ in 0..TRIES {
        let Written::Some(count) = port.write(bytes) else {
            return;
        };
        bytes = &bytes[count..];
        if bytes.is_empty() {
            return;
        }
        std::thread::sleep(PAUSE);
    }
}

/// Watches until the host ends.
pub fn main() {
    leave_the_group();
    let Some(sheet) = handed_sheet() else { return };
    let mut port = Port::handed_over();
    while ![DISMISSED, LEFT].contains(&sheet.holder.load(SeqCst)) {
        sheet.looks.fetch_add(1, Release);
        let alive = sheet.alive_ns.load(Acquire);
        let silence = now_ns().saturating_sub(alive);
        let is_watched = alive > 0 && sheet.holder.load(SeqCst) == HOST;
        let wait = if is_watched {
            SILENCE_NS.saturating_sub(silence).div_ceil(MS) as u32
        } else {
            IDLE_MS
        };
        if host_ends_within(wait) {
            break;
        }
        // As long as it was asleep the host may have lived.
        let silence = now_ns().saturating_sub(sheet.alive_ns.load(Acquire));
        let is_silent = is_watched && silence >= SILENCE_NS;
        let takes = || {
            sheet
                .holder
                .compare_exchange(HOST, GUARDIAN, SeqCst, SeqCst)
        };
        if is_silent && takes().is_ok() {
            speak(&mut port, sheet, true);
        }
    }
    if sheet.holder.swap(GUARDIAN, SeqCst) != DISMISSED {
        speak(&mut port, sheet, false);
        port.unlock();
    }
}
