//! Received bytes that are no whole answer yet.

use crate::device::haply::message::ANSWER_BYTES;

/// Bytes that arrived and are no answer yet.
#[derive(Debug, Clone, Copy)]
pub struct Inbox {
    bytes: [u8; ANSWER_BYTES],
    length: usize,
}

impl Inbox {
    /// Nothing has come.
    pub const EMPTY: Self = Self {
        bytes: [0; ANSWER_BYTES],
        length: 0,
    };

    /// The bytes so far.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }

    /// Takes a byte; all of them when they are as many as an answer has.
    pub fn push(&mut self, byte: u8) -> Option<[u8; ANSWER_BYTES]> {
        self.bytes[self.length] = byte;
        self.length += 1;
        (self.length == ANSWER_BYTES).then_some(self.bytes)
    }

    /// Forgets the first `count` bytes.
    pub fn drop_first(&mut self, count: usize) {
        self.bytes.copy_within(count..self.length, 0);
        self.length -= count;
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        *self = Self::EMPTY;
    }
}
