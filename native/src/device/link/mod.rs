//! The link: the project's own protocol of serial devices (`docs/link.md`).

pub mod codec;
mod device;
mod doubt;
mod freshness;
pub mod messages;
mod newest;
mod orientation;
mod pacing;
mod sending;
mod session;

pub use device::LinkDevice;
