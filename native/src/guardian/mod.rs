//! The guardian: a process that says zero to a device when its host ends without a word, for whatever
//! reason, or stops.
//!
//! It is a small program of its own (`program.rs`), which this library carries and starts when a port
//! is opened. The tick tells it by shared memory that it lives and what is to be said for it, and looks
//! whether it is there.

pub mod program;
mod refusal;

#[cfg(unix)]
mod unix;
#[cfg(unix)]
pub use unix::Guardian;

#[cfg(windows)]
mod windows;
#[cfg(windows)]
pub use windows::Guardian;

use std::sync::atomic::Ordering::{Relaxed, Release, SeqCst};

use crate::guardian::program::{GUARDIAN, HOST, MOST_BYTES, Sheet, now_ns};

/// What the tick finds of its guardian.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Watch {
    /// Nothing has happened.
    Kept,
    /// The servo was taken for dead since the last tick, and its last word was said.
    Spoke,
    /// There is none, and there shall be one: should the servo end, nobody says zero.
    Absent,
}

static PROGRAM: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/guardian.program"));

/// Writes on the sheet that the host lives, and what is to be said should it end: at most
/// [`MOST_BYTES`]. False if it was taken for dead since the last time, and the word before was said.
fn sign(sheet: &Sheet, last_word: &[u8]) -> bool {
    let next = (sheet.newest.load(Relaxed) + 1) % 2;
    let word = &sheet.words[next as usize];
    let length = last_word.len().min(MOST_BYTES);
    word.length.store(length as u32, Relaxed);
    for (stored, byte) in word.bytes.iter().zip(last_word) {
        stored.store(*byte, Relaxed);
    }
    sheet.newest.store(next, Release);
    sheet.alive_ns.store(now_ns(), Release);
    sheet.holder.swap(HOST, SeqCst) != GUARDIAN
}
