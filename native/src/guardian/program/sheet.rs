//! What host and guardian know of each other.

use std::sync::atomic::{AtomicU8, AtomicU32, AtomicU64};

/// Longest last word, bytes.
pub const MOST_BYTES: usize = 64;

/// Holds the port: the host.
pub const HOST: u32 = 0;
/// Holds the port: the guardian, which has said the last word or is about to.
pub const GUARDIAN: u32 = 1;
/// The host has let its device go and ends.
pub const DISMISSED: u32 = 2;
/// The host has left the port without letting the device go: the last word, and the end.
pub const LEFT: u32 = 3;

/// A last word.
#[repr(C)]
#[derive(Debug)]
pub struct Word {
    /// Bytes of it; 0: there is nothing to say.
    pub length: AtomicU32,
    /// The bytes.
    pub bytes: [AtomicU8; MOST_BYTES],
}

/// Memory that host and guardian share. All zero is a host that has not begun.
#[repr(C)]
#[derive(Debug)]
pub struct Sheet {
    /// The host's last sign of life by [`now_ns`]; 0 before the first.
    pub alive_ns: AtomicU64,
    /// How often the guardian has looked, round and round.
    pub looks: AtomicU32,
    /// [`HOST`], [`GUARDIAN`], [`DISMISSED`] or [`LEFT`].
    pub holder: AtomicU32,
    /// Which of the two words counts; the host writes the other one.
    pub newest: AtomicU32,
    /// What is to be said.
    pub words: [Word; 2],
}

/// What came of writing to the port.
pub enum Written {
    /// So many bytes were taken.
    Some(usize),
    /// The port is gone: nobody is there to be told.
    Gone,
}
