//! Memory and a program that have a name for a moment: macOS, which knows none without. Tested on Linux.

use std::ffi::{CString, OsStr};
use std::fs::{File, OpenOptions, remove_file};
use std::io::{self, Write};
use std::os::fd::FromRawFd;
use std::os::unix::fs::OpenOptionsExt;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Two ports may be opened at once, by threads of their own.
static NEXT: AtomicU32 = AtomicU32::new(0);

/// A name that nothing else has: of this process and this call.
fn once(name: &str) -> String {
    format!(
        "{name}-{}-{}",
        std::process::id(),
        NEXT.fetch_add(1, Relaxed)
    )
}

/// Memory as a file, all zero, whose name is gone when this returns. Names of macOS have 31 letters at
/// most, the first of them a slash (`PSHMNAMLEN`).
pub(super) fn memory(name: &str, bytes: usize) -> io::Result<File> {
    let name = CString::new(format!("/{}", once(name)))?;
    let flags = libc::O_RDWR | libc::O_CREAT | libc::O_EXCL;
    // SAFETY: the name ends with a zero and is given back at once; what is returned is a new descriptor,
    // closed when another program is started, or an error.
    let file = unsafe {
        let descriptor = libc::shm_open(name.as_ptr(), flags, 0o600);
        if descriptor == -1 {
            return Err(io::Error::last_os_error());
        }
        libc::shm_unlink(name.as_ptr());
        libc::fcntl(descriptor, libc::F_SETFD, libc::FD_CLOEXEC);
        File::from_raw_fd(descriptor)
    };
    file.set_len(bytes as u64)?;
    Ok(file)
}

/// Starts something with a path to the program, which is on the disk only as long as that takes.
pub(super) fn with_program<T>(
    program: &[u8],
    start: impl FnOnce(&OsStr) -> io::Result<T>,
) -> io::Result<T> {
    let path = std::env::temp_dir().join(once("palpate-guardian"));
    let mut open = OpenOptions::new();
    let mut file = open.write(true).create_new(true).mode(0o700).open(&path)?;
    let written = file.write_all(program);
    drop(file);
    let started = written.and_then(|()| start(path.as_ref()));
    remove_file(&path)?;
    started
}

#[cfg(test)]
mod tests {
    use std::io::Read;
    use std::os::unix::fs::{FileExt, PermissionsExt};
    use std::path::PathBuf;

    use super::*;

    #[test]
    fn memories_made_at_once_are_each_their_own() {
        let make = |mark: u8| {
            let files = (0..200).map(|_| memory("palpate-sheet", 64).unwrap());
            let files = files.collect::<Vec<_>>();
            for file in &files {
                assert_eq!(file.metadata().unwrap().len(), 64);
                file.write_all_at(&[mark; 64], 0).unwrap();
            }
            files
        };
        let (ones, twos) = std::thread::scope(|scope| {
            let other = scope.spawn(|| make(2));
            (make(1), other.join().unwrap())
        });
        for (mark, files) in [(1, ones), (2, twos)] {
            for mut file in files {
                let mut read = Vec::new();
                file.read_to_end(&mut read).unwrap();
                assert_eq!(read, [mark; 64]);
            }
        }
    }

    #[test]
    fn no_name_is_longer_than_macos_takes() {
        // The largest numbers of processes and of calls that are met there.
        let longest = format!("/palpate-sheet-{}-{}", 99_999, 999_999);
        assert!(longest.len() <= 31, "{longest}");
    }

    #[test]
    fn a_program_is_there_for_its_owner_while_it_is_started_and_gone_then() {
        let path = with_program(b"what is run", |path| {
            let path = PathBuf::from(path);
            assert_eq!(std::fs::read(&path)?, b"what is run");
            assert_eq!(
                std::fs::metadata(&path)?.permissions().mode() & 0o777,
                0o700
            );
            Ok(path)
        });
        assert!(!path.unwrap().exists());
    }

    #[test]
    fn a_program_that_does_not_start_is_gone_too() {
        let mut left = PathBuf::new();
        let refused = with_program(b"", |path| {
            left = PathBuf::from(path);
            Err::<(), _>(io::Error::other("no"))
        });
        assert_eq!(refused.unwrap_err().to_string(), "no");
        assert!(!left.as_os_str().is_empty() && !left.exists());
    }
}
