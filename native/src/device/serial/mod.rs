//! Ports that may be unplugged and come back.

#[cfg(windows)]
mod com_port;
mod errands;
pub mod guarded;
pub(crate) mod line;
pub mod port;
pub mod reopening;
mod socket;
#[cfg(unix)]
mod terminal;
mod twin;
pub mod wire;
