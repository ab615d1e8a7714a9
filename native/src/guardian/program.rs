//! The guardian: a program that says zero to a device when its host cannot any more.
//!
//! `build.rs` compiles this file alone, so it uses no crate; the library sees the [`Sheet`] by which the
//! two know of each other. The host gives it a line that breaks when the host ends (standard input), the
//! device's port (standard output) and the sheet (standard error), and nothing else.

use std::ffi::{c_int, c_long, c_void};
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::os::fd::FromRawFd;
use std::sync::atomic::Ordering::{Acquire, SeqCst};
use std::sync::atomic::{AtomicU8, AtomicU32, AtomicU64};
use std::time::Duration;

/// A host that has given no sign of life for so long has stopped, ns: the zero that follows is there
/// within 20 ms, when a device's own watchdog would wait no longer either.
pub const SILENCE_NS: u64 = 12_000_000;
/// Longest last word, bytes.
pub const MOST_BYTES: usize = 64;
/// Times that it is said: one may be lost on the line.
const TIMES: u32 = 3;
const PAUSE: Duration = Duration::from_millis(2);
/// Tries to write, a pause each, on a line that is full.
const TRIES: u32 = 10;
/// Wait for a host that has not begun, or that was silenced, ms.
const IDLE_MS: c_int = 50;
const MS: u64 = 1_000_000;

/// Holds the port: the host.
pub const HOST: u32 = 0;
/// Holds the port: the guardian, which has said the last word or is about to.
pub const GUARDIAN: u32 = 1;
/// The host has let its device go and ends.
pub const DISMISSED: u32 = 2;

/// A last word.
#[repr(C)]
#[derive(Debug)]
pub struct Word {
    /// Bytes of it; 0: there is nothing to say.
    pub length: AtomicU32,
    /// The bytes.
    pub bytes: [AtomicU8; MOST_BYTES],
}

/// Memory that host and guardian share. All zero is a host that has not begun.
#[repr(C)]
#[derive(Debug)]
pub struct Sheet {
    /// The host's last sign of life by [`now_ns`]; 0 before the first.
    pub alive_ns: AtomicU64,
    /// [`HOST`], [`GUARDIAN`] or [`DISMISSED`].
    pub holder: AtomicU32,
    /// Which of the two words counts; the host writes the other one.
    pub newest: AtomicU32,
    /// What is to be said.
    pub words: [Word; 2],
}

#[cfg(target_os = "macos")]
mod system {
    pub const CLOCK_MONOTONIC: i32 = 6;
    pub const TCOFLUSH: i32 = 2;
    pub const TIOCNXCL: u64 = 0x2000_740E;
}
#[cfg(not(target_os = "macos"))]
mod system {
    pub const CLOCK_MONOTONIC: i32 = 1;
    pub const TCOFLUSH: i32 = 1;
    pub const TIOCNXCL: u64 = 0x540D;
}

#[repr(C)]
struct Poll {
    descriptor: c_int,
    events: i16,
    found: i16,
}

unsafe extern "C" {
    fn clock_gettime(clock: c_int, time: *mut [c_long; 2]) -> c_int;
    fn ioctl(descriptor: c_int, request: u64, ...) -> c_int;
    fn mmap(
        at: *mut c_void,
        bytes: usize,
        may: c_int,
        how: c_int,
        from: c_int,
        offset: i64,
    ) -> *mut c_void;
    fn poll(watched: *mut Poll, count: usize, ms: c_int) -> c_int;
    fn setsid() -> c_int;
    fn signal(number: c_int, handler: usize) -> usize;
    fn tcflush(descriptor: c_int, queue: c_int) -> c_int;
}

#[cfg(target_os = "linux")]
unsafe extern "C" {
    fn sched_setscheduler(process: c_int, policy: c_int, priority: *const c_int) -> c_int;
}

/// Time by a clock that all processes share, ns.
pub fn now_ns() -> u64 {
    let mut time = [0; 2];
    // SAFETY: writes two integers, the seconds and nanoseconds of the system's `timespec`.
    let _ = unsafe { clock_gettime(system::CLOCK_MONOTONIC, &raw mut time) };
    time[0] as u64 * 1_000_000_000 + time[1] as u64
}

/// The sheet in the file `descriptor`; None when the system maps none.
pub fn map_sheet(descriptor: c_int) -> Option<&'static Sheet> {
    const READ_AND_WRITE: c_int = 1 | 2;
    const SHARED: c_int = 1;
    // SAFETY: a new mapping of a file that is as long as the sheet, never unmapped by this function;
    // all bits make a sheet, and all of it is atomic.
    unsafe {
        let at = mmap(
            std::ptr::null_mut(),
            size_of::<Sheet>(),
            READ_AND_WRITE,
            SHARED,
            descriptor,
            0,
        );
        (at as isize != -1).then(|| &*at.cast::<Sheet>())
    }
}

/// Whether the host has ended, or begins to within so many ms.
fn host_ends_within(ms: c_int) -> bool {
    let mut line = Poll {
        descriptor: 0,
        events: 1,
        found: 0,
    };
    // SAFETY: one entry, as told. An interruption is no event.
    unsafe { poll(&raw mut line, 1, ms) > 0 && line.found != 0 }
}

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
fn speak(port: &mut File, sheet: &Sheet, host_may_come_back: bool) {
    let (bytes, length) = last_word(sheet);
    if length == 0 {
        return;
    }
    // SAFETY: the port is open; the call touches no memory. What cannot be thrown away is sent.
    let _ = unsafe { tcflush(1, system::TCOFLUSH) };
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

fn write_all(port: &mut File, mut bytes: &[u8]) {
    for _ in 0..TRIES {
        match port.write(bytes) {
            Ok(written) if written < bytes.len() => bytes = &bytes[written..],
            Err(e) if e.kind() == ErrorKind::Interrupted => continue,
            Err(e) if e.kind() == ErrorKind::WouldBlock => {}
            // All of it, or a port that is gone: nobody is there to be told.
            _ => return,
        }
        std::thread::sleep(PAUSE);
    }
}

/// Leaves whatever would end the guardian before its host or with it.
fn leave_the_group() {
    const IGNORED: usize = 1;
    // SAFETY: these calls touch no memory but the priority that is passed. A session of its own is
    // refused to nobody but the leader of one; priority is refused to most, and then there is none.
    unsafe {
        setsid();
        for number in [1, 2, 3, 15] {
            signal(number, IGNORED);
        }
        #[cfg(target_os = "linux")]
        {
            let (first_in_first_out, priority) = (1, 20);
            sched_setscheduler(0, first_in_first_out, &raw const priority);
        }
    }
}

/// Watches until the host ends.
pub fn main() {
    leave_the_group();
    let Some(sheet) = map_sheet(2) else { return };
    // SAFETY: standard output is the port, and nothing else here uses it.
    let mut port = unsafe { File::from_raw_fd(1) };
    loop {
        let alive = sheet.alive_ns.load(Acquire);
        let silence = now_ns().saturating_sub(alive);
        let is_watched = alive > 0 && sheet.holder.load(SeqCst) == HOST;
        let wait = if is_watched {
            (SILENCE_NS.saturating_sub(silence)).div_ceil(MS) as c_int
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
        // SAFETY: the port is open. Its exclusive mode would outlast the host.
        let _ = unsafe { ioctl(1, system::TIOCNXCL) };
    }
}
