//! The host's end: starts the guardian, tells it every tick that the host lives, and dismisses it.

use std::io;
use std::os::fd::{AsRawFd, BorrowedFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::Ordering::SeqCst;

use crate::guardian::end::end;
#[cfg(not(target_os = "linux"))]
use crate::guardian::named::{memory, with_program};
#[cfg(target_os = "linux")]
use crate::guardian::nameless::{memory, with_program};
use crate::guardian::program::{DISMISSED, LEFT, Sheet, map_sheet};
use crate::guardian::refusal::refused;
use crate::guardian::watch::{Attention, PROGRAM, Watch, watch};

/// As lists of processes tell it.
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
        let paper = memory("palpate-sheet", size_of::<Sheet>()).map_err(refused)?;
        let sheet =
            map_sheet(paper.as_raw_fd()).ok_or_else(|| refused(io::Error::last_os_error()))?;
        // SAFETY: the descriptor is open for as long as it is borrowed.
        let port = unsafe { BorrowedFd::borrow_raw(port.as_raw_fd()) };
        let port = port.try_clone_to_owned().map_err(refused)?;
        let child = with_program(PROGRAM, |path| {
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
