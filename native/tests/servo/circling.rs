//! A device in memory that circles over the body.

use glam::DVec3;
use palpate_servo::device::link::codec::{Decoder, MAX_FRAME, encode};
use palpate_servo::device::serial::wire::{Opener, Wire};
use std::io;

/// A device in memory that answers HELLO and then circles over the body, in and out; now and then
/// it loses a frame, damages one, sends too much, or nothing.
pub struct Circling {
    out: [u8; 1024],
    filled: usize,
    taken: usize,
    heard: Decoder,
    tick: u32,
    greeted: bool,
    forces: u64,
    /// Last FORCE that it took.
    named: u16,
}

impl Circling {
    pub fn put(&mut self, payload: &[u8]) {
        let mut frame = [0; MAX_FRAME];
        let length = encode(payload, &mut frame).expect("it fits");
        if self.tick % 97 == 0 {
            frame[3] ^= 0x40;
        }
        self.out[self.filled..self.filled + length].copy_from_slice(&frame[..length]);
        self.filled += length;
    }

    /// Now and then one that is none, or of another STATE.
    pub fn orientation(&mut self) {
        let half = 0.1 * (f64::from(self.tick) * 1e-3).sin();
        let other = u32::from(self.tick % 13 == 0);
        let unit = if self.tick % 17 == 0 { 2e4 } else { 32_767.0 };
        let mut payload = [0; 11];
        payload[0] = 5;
        payload[1..3].copy_from_slice(&((self.tick + other) as u16).to_le_bytes());
        payload[3..5].copy_from_slice(&((half.cos() * unit) as i16).to_le_bytes());
        payload[5..7].copy_from_slice(&((half.sin() * unit) as i16).to_le_bytes());
        self.put(&payload);
    }

    pub fn state(&mut self) {
        let t = f64::from(self.tick) * 1e-3;
        let height = 0.052 - 0.008 * (1.0 - (t * 2.0).cos()) / 2.0;
        let p = DVec3::new(
            0.025 + 0.02 * t.cos(),
            0.025 + 0.02 * (t * 1.3).sin(),
            height,
        );
        let mut payload = [0; 23];
        payload[0] = 2;
        payload[1..3].copy_from_slice(&(self.tick as u16).to_le_bytes());
        payload[3..7].copy_from_slice(&(self.tick.wrapping_mul(1000)).to_le_bytes());
        for (i, x) in p.to_array().into_iter().enumerate() {
            let um = (x * 1e6).round() as i32;
            payload[7 + 4 * i..11 + 4 * i].copy_from_slice(&um.to_le_bytes());
        }
        payload[20] = 5;
        payload[21..].copy_from_slice(&self.named.to_le_bytes());
        self.orientation();
        self.put(&payload);
    }
}

impl Wire for Circling {
    fn waiting(&mut self) -> io::Result<usize> {
        if self.taken == self.filled {
            (self.taken, self.filled) = (0, 0);
            self.tick += 1;
            if self.greeted && self.tick % 31 != 0 {
                self.state();
            }
            if self.tick % 501 == 0 {
                self.out[self.filled..self.filled + 200].fill(0x55);
                self.filled += 200;
            }
            return Ok(0);
        }
        Ok(self.filled - self.taken)
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = buffer.len().min(self.filled - self.taken);
        buffer[..length].copy_from_slice(&self.out[self.taken..self.taken + length]);
        self.taken += length;
        Ok(length)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut hello = false;
        for &byte in bytes {
            match self.heard.push(byte) {
                Some([1, 2]) => hello = true,
                Some([3, low, high, ..]) => {
                    self.forces += 1;
                    self.named = u16::from_le_bytes([*low, *high]);
                }
                _ => {}
            }
        }
        if hello && !self.greeted {
            self.greeted = true;
            let mut payload = [0; 39];
            payload[..2].copy_from_slice(&[1, 2]);
            payload[18] = 3;
            payload[19..23].copy_from_slice(&2.5_f32.to_le_bytes());
            self.put(&payload);
        }
        Ok(bytes.len())
    }
}

pub struct InMemory;

impl Opener for InMemory {
    type Wire = Circling;

    fn open(&mut self) -> io::Result<Circling> {
        Ok(Circling {
            out: [0; 1024],
            filled: 0,
            taken: 0,
            heard: Decoder::default(),
            tick: 0,
            greeted: false,
            forces: 0,
            named: 0,
        })
    }
}
