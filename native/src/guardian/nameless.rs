//! Memory and a program that have no name in the system: Linux.

use std::ffi::{CString, OsStr};
use std::fs::File;
use std::io::{self, Write};
use std::os::fd::{AsRawFd, FromRawFd};

/// Memory as a file, all zero, that no other program can name; lists of files tell the name.
pub(super) fn memory(name: &str, bytes: usize) -> io::Result<File> {
    let name = CString::new(name)?;
    // SAFETY: the name ends with a zero; what is returned is a new descriptor or an error.
    let file = unsafe {
        match libc::memfd_create(name.as_ptr(), libc::MFD_CLOEXEC) {
            -1 => return Err(io::Error::last_os_error()),
            descriptor => File::from_raw_fd(descriptor),
        }
    };
    file.set_len(bytes as u64)?;
    Ok(file)
}

/// Starts something with a path to the program, which is nowhere on the disk.
pub(super) fn with_program<T>(
    program: &[u8],
    start: impl FnOnce(&OsStr) -> io::Result<T>,
) -> io::Result<T> {
    let mut file = memory("palpate-guardian", 0)?;
    file.write_all(program)?;
    start(format!("/proc/self/fd/{}", file.as_raw_fd()).as_ref())
}
