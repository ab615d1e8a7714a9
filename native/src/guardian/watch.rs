//! What the tick tells its guardian, and finds of it.

use std::sync::atomic::Ordering::{Acquire, Relaxed, Release, SeqCst};

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

/// A guardian that has not looked for so long in which the host lived has stopped, ns: it looks every
/// 12 ms, and busy machines have kept one waiting for 55.
const STOPPED_NS: u64 = 200_000_000;
/// What one tick counts at most, ns: in a longer time the host did not live, and its guardian perhaps
/// not either.
const MOST_COUNTED_NS: u64 = 5_000_000;

/// Whether a guardian looks, as its host sees it.
#[derive(Debug, Default)]
pub(super) struct Attention {
    looks: u32,
    /// By [`now_ns`], when it was last asked.
    asked_ns: u64,
    /// Since it looked, ns.
    silent_ns: u64,
}

impl Attention {
    fn is_paid(&mut self, looks: u32, now_ns: u64) -> bool {
        let last_ns = std::mem::replace(&mut self.asked_ns, now_ns);
        if std::mem::replace(&mut self.looks, looks) == looks {
            self.silent_ns += now_ns.saturating_sub(last_ns).min(MOST_COUNTED_NS);
        } else {
            self.silent_ns = 0;
        }
        self.silent_ns < STOPPED_NS
    }
}

/// One tick of the host: signs the sheet, and looks for the guardian, which is a process or not.
pub(super) fn watch(
    sheet: &Sheet,
    last_word: &[u8],
    attention: &mut Attention,
    is_process: bool,
) -> Watch {
    let was_kept = sign(sheet, last_word);
    let looks = attention.is_paid(sheet.looks.load(Acquire), now_ns());
    match (was_kept, is_process && looks) {
        (false, _) => Watch::Spoke,
        (true, true) => Watch::Kept,
        (true, false) => Watch::Absent,
    }
}

pub(super) static PROGRAM: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/guardian.program"));

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

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn one_that_looks_now_and_then_is_there_and_one_that_stops_is_not() {
        let mut attention = Attention::default();
        for ms in 1..1000 {
            assert!(attention.is_paid((ms / 55) as u32, ms * MS));
        }
        let stopped = (1000..2000).find(|ms| !attention.is_paid(18, ms * MS));
        assert_eq!(stopped, Some(1190));
    }

    #[test]
    fn time_in_which_the_host_stood_still_does_not_count() {
        let mut attention = Attention::default();
        assert!(attention.is_paid(0, MS));
        assert!(attention.is_paid(0, 3_600_000 * MS));
    }
}
