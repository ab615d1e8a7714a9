//! The host's end on Windows: starts the guardian, tells it every tick that the host lives, and dismisses
//! it.

use std::io;
use std::net::TcpStream;
use std::os::windows::io::{
    AsRawHandle, AsRawSocket, BorrowedHandle, FromRawHandle, OwnedHandle, RawHandle,
};
use std::os::windows::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::ptr::null;
use std::sync::atomic::Ordering::SeqCst;

use windows_sys::Win32::Foundation::INVALID_HANDLE_VALUE;
use windows_sys::Win32::System::Memory::{
    CreateFileMappingW, MEMORY_MAPPED_VIEW_ADDRESS, PAGE_READWRITE, UnmapViewOfFile,
};
use windows_sys::Win32::System::Threading::{CREATE_NO_WINDOW, GetCurrentProcess};

use crate::guardian::end::end;
use crate::guardian::program::{DISMISSED, LEFT, Sheet, map_sheet};
use crate::guardian::refusal::refused;
use crate::guardian::watch::{Attention, PROGRAM, Watch, watch};

const SYSTEM_ROOT: &str = "SystemRoot";

/// A port that can be handed to another process.
pub trait Handed {
    /// Its handle, valid for as long as it is borrowed.
    fn handle(&self) -> RawHandle;
}

impl Handed for OwnedHandle {
    fn handle(&self) -> RawHandle {
        self.as_raw_handle()
    }
}

impl Handed for TcpStream {
    fn handle(&self) -> RawHandle {
        self.as_raw_socket() as RawHandle
    }
}

/// A process that watches this one, for one open port.
#[derive(Debug)]
pub struct Guardian {
    sheet: &'static Sheet,
    child: Child,
    attention: Attention,
    is_dismissed: bool,
}

impl Guardian {
    /// Starts one for this port. Takes some milliseconds: never in a tick.
    ///
    /// # Errors
    /// When the system does not let it run.
    pub fn of(port: &impl Handed) -> io::Result<Self> {
        if PROGRAM.is_empty() {
            return Err(refused("this build has none"));
        }
        let paper = memory().map_err(refused)?;
        let sheet =
            map_sheet(paper.as_raw_handle()).ok_or_else(|| refused(io::Error::last_os_error()))?;
        // SAFETY: the port is open for as long as it is borrowed, and a process's own handle always.
        let (port, host) = unsafe {
            let this_process = BorrowedHandle::borrow_raw(GetCurrentProcess());
            let port = BorrowedHandle::borrow_raw(port.handle());
            (
                port.try_clone_to_owned().map_err(refused)?,
                this_process.try_clone_to_owned().map_err(refused)?,
            )
        };
        let child = Command::new(program().map_err(refused)?)
            .env_clear()
            // By which Windows finds parts of itself.
            .envs(std::env::var_os(SYSTEM_ROOT).map(|root| (SYSTEM_ROOT, root)))
            .stdin(Stdio::from(host))
            .stdout(Stdio::from(port))
            .stderr(Stdio::from(paper))
            .creation_flags(CREATE_NO_WINDOW)
            .spawn()
            .map_err(refused)?;
        Ok(Self {
            sheet,
            child,
            attention: Attention::default(),
            is_dismissed: false,
        })
    }

    /// Says that the host lives, and what is to be said should it end. Never waits.
    pub fn live(&mut self, last_word: &[u8]) -> Watch {
        let is_there = matches!(self.child.try_wait(), Ok(None));
        watch(self.sheet, last_word, &mut self.attention, is_there)
    }

    /// The device was let go: nothing will be left to say.
    pub fn dismiss(&mut self) {
        self.is_dismissed = true;
    }
}

impl Drop for Guardian {
    /// Has the last word said, unless it was dismissed.
    fn drop(&mut self) {
        let end_of_all = if self.is_dismissed { DISMISSED } else { LEFT };
        self.sheet.holder.store(end_of_all, SeqCst);
        end(&mut self.child, self.is_dismissed);
        let at = MEMORY_MAPPED_VIEW_ADDRESS {
            Value: std::ptr::from_ref(self.sheet).cast_mut().cast(),
        };
        // SAFETY: mapped by `map_sheet` for this one alone, and used no more.
        let _ = unsafe { UnmapViewOfFile(at) };
    }
}

/// Memory as a file mapping, all zero, that no other program can name.
fn memory() -> io::Result<OwnedHandle> {
    let bytes = size_of::<Sheet>() as u32;
    // SAFETY: no attributes and no name are passed; what is returned is a new handle or none.
    unsafe {
        let mapping = CreateFileMappingW(
            INVALID_HANDLE_VALUE,
            null(),
            PAGE_READWRITE,
            0,
            bytes,
            null(),
        );
        if mapping.is_null() {
            return Err(io::Error::last_os_error());
        }
        Ok(OwnedHandle::from_raw_handle(mapping))
    }
}

/// Path of the program: a file of the user's folder for temporary files, which Windows does not let go
/// as long as it runs. So it stays there, one for each edition of it.
fn program() -> io::Result<PathBuf> {
    let place = |name: String| std::env::temp_dir().join(name);
    let edition = PROGRAM
        .iter()
        .fold(0xCBF2_9CE4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3)
        });
    let path = place(format!("palpate-guardian-{edition:016x}.exe"));
    if std::fs::read(&path).is_ok_and(|there| there == PROGRAM) {
        return Ok(path);
    }
    let draft = place(format!("palpate-guardian-{}.tmp", std::process::id()));
    std::fs::write(&draft, PROGRAM)?;
    std::fs::rename(&draft, &path)?;
    Ok(path)
}
