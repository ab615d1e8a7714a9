//! The host's end: starts the guardian, tells it every tick that the host lives, and dismisses it.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Write};
use std::os::fd::{AsRawFd, BorrowedFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::Ordering::SeqCst;

use crate::guardian::end::end;
#[cfg(not(target_os = "linux"))]
use crate::guardian::program::now_ns;
use crate::guardian::program::{DISMISSED, LEFT, Sheet, map_sheet};
use crate::guardian::refusal::refused;
use crate::guardian::watch::{Attention, PROGRAM, Watch, watch};

const NAME: &str = "palpate-guardian";

/// A process that watches this one, for one open port.
#[derive(Debug)]
pub struct Guardian {
    sheet: &'static Sheet,
    /// Breaks when this process ends, or drops it.
    tie: Option<UnixStream>,
    child: Option<Child>,
    attention: Attention,
    process: u32,
    is_dismissed: bool,
}

impl Guardian {
    /// Starts one for this port. Takes some milliseconds: never in a tick.
    ///
    /// # Errors
    /// When the system does not let it run.
    pub fn of(port: &impl AsRawFd) -> io::Result<Self> {
        if PROGRAM.is_empty() {
            return Err(refused("this build has none"));
        }
        let (tie, its_end) = UnixStream::pair().map_err(refused)?;
        let paper = memory(c"palpate-sheet", size_of::<Sheet>()).map_err(refused)?;
        let sheet =
            map_sheet(paper.as_raw_fd()).ok_or_else(|| refused(io::Error::last_os_error()))?;
        // SAFETY: the descriptor is open for as long as it is borrowed.
        let port = unsafe { BorrowedFd::borrow_raw(port.as_raw_fd()) };
        let port = port.try_clone_to_owned().map_err(refused)?;
        let child = with_program(|path| {
            Command::new(path)
                .arg0(NAME)
                .env_clear()
                .stdin(Stdio::from(OwnedFd::from(its_end.try_clone()?)))
                .stdout(Stdio::from(port.try_clone()?))
                .stderr(Stdio::from(paper.try_clone()?))
                .spawn()
        })
        .map_err(refused)?;
        Ok(Self {
            sheet,
            tie: Some(tie),
            child: Some(child),
            attention: Attention::default(),
            process: std::process::id(),
            is_dismissed: false,
        })
    }

    /// Says that the host lives, and what is to be said should it end. Never waits.
    pub fn live(&mut self, last_word: &[u8]) -> Watch {
        let is_there =
            (self.child.as_mut()).is_some_and(|child| matches!(child.try_wait(), Ok(None)));
        watch(self.sheet, last_word, &mut self.attention, is_there)
    }

    /// Its process, for tests that hold it up.
    #[cfg(feature = "harness")]
    pub fn process(&self) -> Option<u32> {
        self.child.as_ref().map(Child::id)
    }

    /// The device was let go: nothing will be left to say.
    pub fn dismiss(&mut self) {
        self.is_dismissed = true;
    }
}

impl Drop for Guardian {
    /// Has the last word said, unless it was dismissed. In a fork the guardian is the parent's.
    fn drop(&mut self) {
        let Some(mut child) = self.child.take() else {
            return;
        };
        if self.process != std::process::id() {
            return;
        }
        let end_of_all = if self.is_dismissed { DISMISSED } else { LEFT };
        self.sheet.holder.store(end_of_all, SeqCst);
        self.tie = None;
        end(&mut child, self.is_dismissed);
        let at = std::ptr::from_ref(self.sheet).cast_mut();
        // SAFETY: mapped by `map_sheet` for this one alone, and used no more.
        let _ = unsafe { libc::munmap(at.cast(), size_of::<Sheet>()) };
    }
}

/// Memory as a file, all zero, that no other program can name.
#[cfg(target_os = "linux")]
fn memory(name: &std::ffi::CStr, bytes: usize) -> io::Result<File> {
    use std::os::fd::FromRawFd;
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

#[cfg(not(target_os = "linux"))]
fn memory(name: &std::ffi::CStr, bytes: usize) -> io::Result<File> {
    use std::os::fd::FromRawFd;
    let name = format!("/{}-{}\0", name.to_string_lossy(), std::process::id());
    let flags = libc::O_RDWR | libc::O_CREAT | libc::O_EXCL;
    // SAFETY: the name ends with a zero and is given back at once; what is returned is a new descriptor,
    // closed when another program is started, or an error.
    let file = unsafe {
        let descriptor = libc::shm_open(name.as_ptr().cast(), flags, 0o600);
        if descriptor == -1 {
            return Err(io::Error::last_os_error());
        }
        libc::shm_unlink(name.as_ptr().cast());
        libc::fcntl(descriptor, libc::F_SETFD, libc::FD_CLOEXEC);
        File::from_raw_fd(descriptor)
    };
    file.set_len(bytes as u64)?;
    Ok(file)
}

/// Starts something with a path to the program, which is nowhere on the disk.
#[cfg(target_os = "linux")]
fn with_program<T>(start: impl FnOnce(&OsStr) -> io::Result<T>) -> io::Result<T> {
    let mut file = memory(c"palpate-guardian", 0)?;
    file.write_all(PROGRAM)?;
    start(format!("/proc/self/fd/{}", file.as_raw_fd()).as_ref())
}

/// Starts something with a path to the program, which is on the disk only as long as that takes.
#[cfg(not(target_os = "linux"))]
fn with_program<T>(start: impl FnOnce(&OsStr) -> io::Result<T>) -> io::Result<T> {
    use std::os::unix::fs::OpenOptionsExt;
    let name = format!("{NAME}-{}-{}", std::process::id(), now_ns());
    let path = std::env::temp_dir().join(name);
    let mut open = std::fs::OpenOptions::new();
    let mut file = open.write(true).create_new(true).mode(0o700).open(&path)?;
    let written = file.write_all(PROGRAM);
    drop(file);
    let started = written.and_then(|()| start(path.as_ref()));
    std::fs::remove_file(&path)?;
    started
}
