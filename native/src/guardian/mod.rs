//! The guardian: a process that says zero to a device when its host ends without a word, for whatever
//! reason, or stops.
//!
//! It is a small program of its own (`program.rs`), which this library carries and starts when a port
//! is opened. The tick tells it by shared memory that it lives and what is to be said for it.

#[cfg(unix)]
pub mod program;
mod refusal;
#[cfg(unix)]
mod unix;
#[cfg(unix)]
pub use unix::Guardian;

#[cfg(not(unix))]
mod elsewhere;
#[cfg(not(unix))]
pub use elsewhere::Guardian;
