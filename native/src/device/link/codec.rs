//! Frames of the link, version 1: COBS(payload + CRC-16/CCITT-FALSE) and a zero byte.

use crc::{CRC_16_IBM_3740, Crc};

/// Longest frame on the wire, delimiter included.
pub const MAX_FRAME: usize = 62;
/// Longest payload: a byte of COBS overhead, two of CRC and the delimiter are added.
pub const MAX_PAYLOAD: usize = MAX_FRAME - 4;

/// The catalogue's name for CRC-16/CCITT-FALSE.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// CRC-16/CCITT-FALSE of a payload.
pub fn checksum(payload: &[u8]) -> u16 {
    CRC.checksum(payload)
}

/// Writes the frame of `payload` and returns its length, or None if the payload is empty or longer
/// than [`MAX_PAYLOAD`].
pub fn encode(payload: &[u8], frame: &mut [u8; MAX_FRAME]) -> Option<usize> {
    if payload.is_empty() || payload.len() > MAX_PAYLOAD {
        return None;
    }
    let mut body = [0; MAX_PAYLOAD + 2];
    let length = payload.len();
    body[..length].copy_from_slice(payload);
    body[length..length + 2].copy_from_slice(&checksum(payload).to_le_bytes());
    let coded = cobs::try_encode(&body[..length + 2], &mut frame[..MAX_FRAME - 1]).ok()?;
    frame[coded] = 0;
    Some(coded + 1)
}

/// Counts of frames that were not sound.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DecodeErrors {
    /// Frames whose checksum did not fit.
    pub crc: u64,
    /// Frames that are not COBS, or too short to hold a payload.
    pub cobs: u64,
    /// Frames longer than [`MAX_FRAME`].
    pub oversize: u64,
}

/// Cuts a stream of bytes into payloads; allocates nothing and finds its way after any error at
/// the next delimiter.
#[derive(Debug, Clone)]
pub struct Decoder {
    buffer: [u8; MAX_FRAME],
    length: usize,
    overflowed: bool,
    /// Errors so far.
    pub errors: DecodeErrors,
}

impl Default for Decoder {
    fn default() -> Self {
        Self {
            buffer: [0; MAX_FRAME],
            length: 0,
            overflowed: false,
            errors: DecodeErrors::default(),
        }
    }
}

impl Decoder {
    /// Forgets a frame that was begun; the error counts stay.
    pub fn resynchronise(&mut self) {
        self.length = 0;
        self.overflowed = false;
    }

    /// Takes one byte; the payload when it ends a sound frame.
    pub fn push(&mut self, byte: u8) -> Option<&[u8]> {
        if byte != 0 {
            // The delimiter must fit too.
            if self.length < MAX_FRAME - 1 {
                self.buffer[self.length] = byte;
                self.length += 1;
            } else {
                self.overflowed = true;
            }
            return None;
        }
        let length = self.length;
        let overflowed = self.overflowed;
        self.resynchronise();
        if overflowed {
            self.errors.oversize += 1;
            return None;
        }
        if length == 0 {
            // Empty frames are allowed as padding between frames.
            return None;
        }
        let decoded = match cobs::decode_in_place(&mut self.buffer[..length]) {
            Ok(decoded) if decoded >= 3 => decoded,
            _ => {
                self.errors.cobs += 1;
                return None;
            }
        };
        let (payload, sum) = self.buffer[..decoded].split_at(decoded - 2);
        if sum != checksum(payload).to_le_bytes() {
            self.errors.crc += 1;
            return None;
        }
        Some(payload)
    }
}
