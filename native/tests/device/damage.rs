//! Streams of sound and damaged frames, the same from the same seed in Rust and in C++
//! (`tests/firmware/damage.h`): one draws what the other draws, in the same order.

use palpate_servo::device::link::codec::{MAX_FRAME, MAX_PAYLOAD, encode};

/// xorshift64* (Vigna 2016).
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(1))
    }

    pub fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % limit
    }

    pub fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }

    /// A byte that is often zero.
    fn content(&mut self) -> u8 {
        if self.below(3) == 0 { 0 } else { self.byte() }
    }
}

/// A piece of a stream, and what may rightly be read where it ends.
pub struct Chunk {
    pub bytes: Vec<u8>,
    /// A whole frame that nothing has touched.
    pub sound: bool,
    pub payloads: Vec<Vec<u8>>,
}

fn payload(dice: &mut Dice) -> Vec<u8> {
    match dice.below(9) {
        0 => vec![1, dice.below(3) as u8],
        1 => {
            let mut hello = vec![1, 1];
            hello.extend((0..35).map(|_| dice.content()));
            hello
        }
        2 => {
            let mut fault = vec![4];
            fault.extend((0..3).map(|_| dice.byte()));
            fault
        }
        3 => {
            let mut force = vec![3];
            force.extend((0..8).map(|_| dice.content()));
            force.push(dice.below(4) as u8);
            force
        }
        4 | 5 => {
            let mut state = vec![2];
            state.extend((0..19).map(|_| dice.content()));
            state.push(dice.below(4) as u8);
            state
        }
        6 => {
            // Half a turn about an axis, or none; one in three with something beside it.
            let mut orientation = vec![5];
            orientation.extend((0..2).map(|_| dice.content()));
            orientation.extend([0; 8]);
            let largest = 3 + 2 * dice.below(4);
            orientation[largest..largest + 2].copy_from_slice(&i16::MAX.to_le_bytes());
            if dice.below(3) == 0 {
                let place = 3 + dice.below(8);
                orientation[place] = dice.byte();
            }
            orientation
        }
        _ => {
            let length = 1 + dice.below(MAX_PAYLOAD);
            (0..length).map(|_| dice.content()).collect()
        }
    }
}

pub fn frame(payload: &[u8]) -> Vec<u8> {
    let mut frame = [0; MAX_FRAME];
    let length = encode(payload, &mut frame).expect("it fits");
    frame[..length].to_vec()
}

fn damage(dice: &mut Dice, chunk: &mut Chunk) {
    let bytes = &mut chunk.bytes;
    let length = bytes.len();
    let at = dice.below(length);
    match dice.below(11) {
        0 => bytes[at] ^= 1 << dice.below(8),
        1 => {
            for _ in 0..2 + dice.below(16) {
                let place = dice.below(length);
                bytes[place] ^= 1 << dice.below(8);
            }
        }
        2 => bytes[at] = dice.byte(),
        3 => {
            for _ in 0..=dice.below(8) {
                bytes.insert(at, dice.byte());
            }
        }
        4 => {
            let end = length.min(at + 1 + dice.below(8));
            bytes.drain(at..end);
        }
        5 => bytes.truncate(at),
        6 => bytes.extend_from_within(..),
        7 => {
            let other = payload(dice);
            let tail = frame(&other);
            let cut = dice.below(tail.len());
            bytes.truncate(at);
            bytes.extend(&tail[cut..]);
            chunk.payloads.push(other);
        }
        8 => {
            for _ in 0..=dice.below(20) {
                bytes.insert(at, 0);
            }
        }
        9 => {
            for _ in 0..62 + dice.below(200) {
                bytes.insert(at, 1 + dice.below(255) as u8);
            }
        }
        _ => bytes[length - 1] = 1 + dice.below(255) as u8,
    }
}

fn noise(bytes: Vec<u8>) -> Chunk {
    Chunk {
        bytes,
        sound: false,
        payloads: Vec::new(),
    }
}

fn chunk(dice: &mut Dice) -> Chunk {
    match dice.below(16) {
        0 => {
            let length = 1 + dice.below(400);
            noise((0..length).map(|_| dice.byte()).collect())
        }
        1 => {
            // Few zeros and many small codes: deeper into the decoder.
            let length = 1 + dice.below(400);
            let mut small = || match dice.below(30) {
                0 => 0,
                _ => 1 + dice.below(6) as u8,
            };
            noise((0..length).map(|_| small()).collect())
        }
        2 => {
            // Runs of three bytes, of which one in 2^16 is a payload with its checksum.
            let mut runs = Vec::new();
            for _ in 0..=dice.below(100) {
                runs.push(4);
                runs.extend((0..3).map(|_| 1 + dice.below(255) as u8));
                runs.push(0);
            }
            noise(runs)
        }
        kind => {
            let payload = payload(dice);
            let mut chunk = Chunk {
                bytes: frame(&payload),
                sound: true,
                payloads: vec![payload],
            };
            if kind < 7 {
                chunk.sound = false;
                damage(dice, &mut chunk);
            }
            chunk
        }
    }
}

/// Chunks of at least so many bytes together.
pub fn stream(seed: u64, bytes: usize) -> impl Iterator<Item = Chunk> {
    let mut dice = Dice::new(seed);
    let mut sent = 0;
    std::iter::from_fn(move || {
        (sent < bytes).then(|| {
            let chunk = chunk(&mut dice);
            sent += chunk.bytes.len();
            chunk
        })
    })
}

/// FNV-1a of 64 bits (RFC 9923).
pub struct Digest(pub u64);

impl Default for Digest {
    fn default() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }
}

impl Digest {
    pub fn take(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3);
        }
    }
}
