//! Serial ports that may be unplugged and come back.

mod errands;
pub mod guarded;
pub(crate) mod line;
pub mod port;
pub mod reopening;
mod twin;
mod wired;
