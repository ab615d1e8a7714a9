//! The guardian: a process that says zero to a device when its host ends without a word, for whatever
//! reason, or stops.
//!
//! It is a small program of its own (`program.rs`), which this library carries and starts when a port
//! is opened. The tick tells it by shared memory that it lives and what is to be said for it, and looks
//! whether it is there.

mod end;
#[cfg(all(unix, any(test, not(target_os = "linux"))))]
mod named;
#[cfg(target_os = "linux")]
mod nameless;
pub mod program;
mod refusal;
mod watch;

pub use watch::Watch;

#[cfg(unix)]
mod unix;
#[cfg(unix)]
pub use unix::Guardian;

#[cfg(windows)]
mod windows;
#[cfg(windows)]
pub use windows::{Guardian, Handed};
