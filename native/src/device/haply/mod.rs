//! Haply 2DIY: a planar five-bar arm on a hAPI board, whose protocol has no frames and no checksum.
//!
//! `docs/haply.md` tells the protocol byte for byte. Here: the arm's geometry ([`pantograph`]), what
//! the makers sold ([`model`]), the bytes ([`message`]) and the device that the servo asks
//! ([`device`]).

mod answers;
pub mod device;
pub mod flight;
pub mod inbox;
pub mod message;
pub mod model;
mod newest;
pub mod pantograph;
pub mod speed;
