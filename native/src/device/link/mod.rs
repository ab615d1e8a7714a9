//! The link, version 1: the project's own protocol of serial devices (`docs/link.md`).

pub mod codec;
mod device;
pub mod messages;
mod orientation;
mod pacing;
mod session;

pub use device::LinkDevice;
