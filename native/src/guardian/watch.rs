//! What the tick tells its guardian, and finds of it.

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

pub(super) static PROGRAM: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/guardian.program"));

/// Writes on the sheet that the host lives, and what is to be said should it end: at most
/// [`MOST_BYTES`]. False if it was taken for dead since the last time, and the word before was said.
pub(super) fn sign(sheet: &Sheet, last_word: &[u8]) -> bool {
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
