//! Linux and macOS.

use std::ffi::{c_int, c_long, c_void};
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::os::fd::FromRawFd;

use super::sheet::{Sheet, Written};

#[cfg(target_os = "macos")]
mod numbers {
    pub const CLOCK_MONOTONIC: i32 = 6;
    pub const TCOFLUSH: i32 = 2;
    pub const TIOCNXCL: u64 = 0x2000_740E;
}
#[cfg(not(target_os = "macos"))]
mod numbers {
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
    let _ = unsafe { clock_gettime(numbers::CLOCK_MONOTONIC, &raw mut time) };
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

/// The sheet that was handed over as standard error.
pub fn handed_sheet() -> Option<&'static Sheet> {
    map_sheet(2)
}

/// Whether the host has ended, or ends within so many ms: the line on standard input breaks.
pub fn host_ends_within(ms: u32) -> bool {
    let mut line = Poll {
        descriptor: 0,
        events: 1,
        found: 0,
    };
    // SAFETY: one entry, as told. An interruption is no event.
    unsafe { poll(&raw mut line, 1, ms as c_int) > 0 && line.found != 0 }
}

/// Leaves whatever would end the guardian before its host or with it.
pub fn leave_the_group() {
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

/// The device's port: standard output.
pub struct Port(File);

impl Port {
    /// The one that was handed over. Once in a program.
    pub fn handed_over() -> Self {
        // SAFETY: standard output is the port, and nothing else here uses it.
        Self(unsafe { File::from_raw_fd(1) })
    }

    /// Throws away what waits. What cannot be thrown away is sent.
    pub fn discard(&self) {
        // SAFETY: the port is open; the call touches no memory.
        let _ = unsafe { tcflush(1, numbers::TCOFLUSH) };
    }

    /// Writes what fits at once.
    pub fn write(&mut self, bytes: &[u8]) -> Written {
        match self.0.write(bytes) {
            Ok(count) => Written::Some(count),
            Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
                Written::Some(0)
            }
            Err(_) => Written::Gone,
        }
    }

    /// Lets others open it: its exclusive mode would outlast the host.
    pub fn unlock(&self) {
        // SAFETY: the port is open.
        let _ = unsafe { ioctl(1, numbers::TIOCNXCL) };
    }
}
