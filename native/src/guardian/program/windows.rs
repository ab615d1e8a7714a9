//! Windows.

use std::ffi::c_void;
use std::ptr::{null, null_mut};

use super::sheet::{Sheet, Written};

/// A kernel object of this process.
pub type Handle = *mut c_void;

const STANDARD_INPUT: u32 = -10_i32 as u32;
const STANDARD_OUTPUT: u32 = -11_i32 as u32;
const STANDARD_ERROR: u32 = -12_i32 as u32;
const READ_AND_WRITE_OF_A_MAPPING: u32 = 2 | 4;
const NOT_YET: u32 = 258;

/// A call that goes on without its caller.
#[repr(C)]
struct Overlapped {
    systems: [usize; 2],
    offset: u64,
    done: Handle,
}

impl Overlapped {
    const NONE: Self = Self {
        systems: [0; 2],
        offset: 0,
        done: null_mut(),
    };
}

#[link(name = "kernel32")]
unsafe extern "system" {
    fn CancelIoEx(file: Handle, call: *mut Overlapped) -> i32;
    fn CloseHandle(object: Handle) -> i32;
    fn CreateEventW(may: *const c_void, by_hand: i32, set: i32, name: *const u16) -> Handle;
    fn GetCurrentProcess() -> Handle;
    fn GetCurrentThread() -> Handle;
    fn GetLastError() -> u32;
    fn GetOverlappedResult(
        file: Handle,
        call: *mut Overlapped,
        count: *mut u32,
        is_waited_for: i32,
    ) -> i32;
    fn GetStdHandle(which: u32) -> Handle;
    fn MapViewOfFile(from: Handle, may: u32, high: u32, low: u32, bytes: usize) -> *mut c_void;
    fn PurgeComm(port: Handle, what: u32) -> i32;
    fn QueryPerformanceCounter(count: *mut i64) -> i32;
    fn QueryPerformanceFrequency(a_second: *mut i64) -> i32;
    fn SetPriorityClass(process: Handle, class: u32) -> i32;
    fn SetThreadPriority(thread: Handle, priority: i32) -> i32;
    fn WaitForSingleObject(object: Handle, ms: u32) -> u32;
    fn WriteFile(
        file: Handle,
        bytes: *const u8,
        count: u32,
        written: *mut u32,
        call: *mut Overlapped,
    ) -> i32;
}

#[link(name = "winmm")]
unsafe extern "system" {
    fn timeBeginPeriod(ms: u32) -> u32;
}

/// Time by a clock that all processes share, ns.
pub fn now_ns() -> u64 {
    let (mut count, mut a_second) = (0, 1);
    // SAFETY: each writes one integer; neither fails on any Windows that Rust knows.
    unsafe {
        QueryPerformanceCounter(&raw mut count);
        QueryPerformanceFrequency(&raw mut a_second);
    }
    (count as u128 * 1_000_000_000 / a_second.max(1) as u128) as u64
}

/// The sheet of a file mapping; None when the system maps none.
pub fn map_sheet(mapping: Handle) -> Option<&'static Sheet> {
    // SAFETY: a new view of a mapping that is as long as the sheet, never unmapped by this function;
    // all bits make a sheet, and all of it is atomic.
    unsafe {
        let at = MapViewOfFile(
            mapping,
            READ_AND_WRITE_OF_A_MAPPING,
            0,
            0,
            size_of::<Sheet>(),
        );
        at.cast::<Sheet>().as_ref()
    }
}

/// The sheet that was handed over as standard error.
pub fn handed_sheet() -> Option<&'static Sheet> {
    // SAFETY: touches no memory.
    map_sheet(unsafe { GetStdHandle(STANDARD_ERROR) })
}

/// Whether the host, which is standard input, has ended or ends within so many ms.
pub fn host_ends_within(ms: u32) -> bool {
    // SAFETY: a handle that stays open; an object that cannot be waited for is a host that is gone.
    unsafe { WaitForSingleObject(GetStdHandle(STANDARD_INPUT), ms) != NOT_YET }
}

/// Takes what priority and exactness of time the system gives.
pub fn leave_the_group() {
    const HIGH_CLASS: u32 = 0x80;
    const TIME_CRITICAL: i32 = 15;
    // SAFETY: these calls touch no memory. What is refused is left as it was.
    unsafe {
        timeBeginPeriod(1);
        SetPriorityClass(GetCurrentProcess(), HIGH_CLASS);
        SetThreadPriority(GetCurrentThread(), TIME_CRITICAL);
    }
}

/// The device's port: standard output.
pub struct Port(Handle);

impl Port {
    /// The one that was handed over.
    pub fn handed_over() -> Self {
        // SAFETY: touches no memory.
        Self(unsafe { GetStdHandle(STANDARD_OUTPUT) })
    }

    /// Throws away what waits, and ends a write of the host's that has not come to an end.
    pub fn discard(&self) {
        const ABORT_AND_CLEAR_OUTPUT: u32 = 1 | 4;
        // SAFETY: the port is open; the call touches no memory. What cannot be thrown away is sent.
        let _ = unsafe { PurgeComm(self.0, ABORT_AND_CLEAR_OUTPUT) };
    }

    /// Writes what fits within a while: the host opened the port for calls that go on without their
    /// caller.
    pub fn write(&mut self, bytes: &[u8]) -> Written {
        const UNDER_WAY: u32 = 997;
        const ENDED_BEFORE: u32 = 995;
        const PATIENCE_MS: u32 = 2;
        // SAFETY: the call's memory and the bytes stay where they are until it is over: it is waited
        // for, and ended where it takes too long.
        unsafe {
            let done = CreateEventW(null(), 1, 0, null());
            let mut call = Overlapped {
                done,
                ..Overlapped::NONE
            };
            let (count, mut written) = (bytes.len() as u32, 0);
            let begun = WriteFile(self.0, bytes.as_ptr(), count, null_mut(), &raw mut call) != 0
                || GetLastError() == UNDER_WAY;
            if begun && WaitForSingleObject(done, PATIENCE_MS) == NOT_YET {
                CancelIoEx(self.0, &raw mut call);
            }
            let is_sound = begun
                && (GetOverlappedResult(self.0, &raw mut call, &raw mut written, 1) != 0
                    || GetLastError() == ENDED_BEFORE);
            CloseHandle(done);
            match is_sound {
                true => Written::Some(written as usize),
                false => Written::Gone,
            }
        }
    }

    /// Nothing: a port is free when its last handle is closed.
    pub fn unlock(&self) {}
}
