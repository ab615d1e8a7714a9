//! A wire in memory, and the device at its end.

use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::sync::{Arc, Mutex};

use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::link::codec::{Decoder, MAX_FRAME, encode};
use palpate_servo::device::serial::wire::{Opener, Wire};
use palpate_servo::device::{Device, DeviceFrame, Reading};
use palpate_servo::guardian::Watch;

#[derive(Default)]
pub struct Line {
    pub to_host: VecDeque<u8>,
    pub payloads: Vec<Vec<u8>>,
    pub decoder: Decoder,
    /// Of the last HELLO.
    pub protocol: u8,
    /// Last FORCE taken.
    pub taken: Option<u16>,
    pub deaf: bool,
    pub gone: bool,
    pub full: bool,
    /// How often the line was read, and opened.
    pub reads: u64,
    pub opened: u64,
    /// What the driver says that it has not sent, bytes; and how often it threw that away.
    pub queued: usize,
    pub discarded: u64,
    /// It does so on a thread of its own, and has now.
    pub discards_later: bool,
    pub has_discarded: bool,
    /// What the tick finds of its guardian.
    pub watch: Option<Watch>,
    /// Its guardian was told that the device was let go.
    pub dismissed: bool,
}

/// Largest damping of the bench, 0.01 N s/m.
pub const DAMPING: u16 = 250;

/// The device's end of the wire.
#[derive(Clone, Default)]
pub struct Bench(pub Arc<Mutex<Line>>);

impl Bench {
    pub fn line(&self) -> std::sync::MutexGuard<'_, Line> {
        self.0.lock().unwrap()
    }

    pub fn send(&self, payload: &[u8]) {
        let mut frame = [0; MAX_FRAME];
        let length = encode(payload, &mut frame).unwrap();
        self.line().to_host.extend(&frame[..length]);
    }

    pub fn hello(&self, protocol: u8, max_force: f32) {
        let mut payload = vec![1, protocol];
        payload.extend([0; 16]);
        payload.push(3);
        payload.extend(max_force.to_le_bytes());
        payload.extend([0; 14]);
        if protocol == 2 {
            payload.extend(DAMPING.to_le_bytes());
        }
        self.send(&payload);
        self.line().protocol = protocol;
    }

    /// Protocol 1 from now on: the host asks in protocol 2 first.
    pub fn is_older(&self) {
        self.hello(1, 2.5);
        self.send(&[4, 2, 2, 0]);
    }

    pub fn state(&self, sequence: u16, micrometres: i32, buttons: u8, flags: u8) {
        self.state_at(
            u32::from(sequence) * 1000,
            sequence,
            micrometres,
            buttons,
            flags,
        );
    }

    pub fn state_at(&self, time_us: u32, sequence: u16, micrometres: i32, buttons: u8, flags: u8) {
        let mut payload = vec![2];
        payload.extend(sequence.to_le_bytes());
        payload.extend(time_us.to_le_bytes());
        for um in [micrometres, 0, 0] {
            payload.extend(um.to_le_bytes());
        }
        let taken = self.line().taken;
        let told = if taken.is_some() { 4 } else { 0 };
        payload.extend([buttons, flags]);
        if self.line().protocol == 2 {
            *payload.last_mut().expect("flags") |= told;
            payload.extend(taken.unwrap_or(0).to_le_bytes());
        }
        self.send(&payload);
    }

    /// A turn about z by so many quarters.
    pub fn turned(&self, sequence: u16, quarters: f64) {
        let half = quarters * std::f64::consts::FRAC_PI_4;
        self.quaternion(sequence, [half.cos(), 0.0, 0.0, half.sin()]);
    }

    pub fn quaternion(&self, sequence: u16, wxyz: [f64; 4]) {
        let mut payload = vec![5];
        payload.extend(sequence.to_le_bytes());
        for component in wxyz {
            payload.extend(((component * 32_767.0).round() as i16).to_le_bytes());
        }
        self.send(&payload);
    }

    pub fn received(&self) -> Vec<Vec<u8>> {
        std::mem::take(&mut self.line().payloads)
    }
}

impl Wire for Bench {
    fn waiting(&mut self) -> io::Result<usize> {
        let line = self.line();
        match line.gone {
            true => Err(io::ErrorKind::BrokenPipe.into()),
            false => Ok(line.to_host.len()),
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut line = self.line();
        // A terminal would wait for somebody who brings more.
        assert!((1..=line.to_host.len()).contains(&buffer.len()));
        line.reads += 1;
        for byte in buffer.iter_mut() {
            *byte = line.to_host.pop_front().expect("it is there");
        }
        Ok(buffer.len())
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut line = self.line();
        if line.full {
            return Err(ErrorKind::WouldBlock.into());
        }
        // Small pieces: partial writes must be continued.
        let piece = &bytes[..bytes.len().min(5)];
        for &byte in piece {
            if let Some(payload) = line.decoder.push(byte).map(<[u8]>::to_vec) {
                if payload[0] == 3 && !line.deaf {
                    line.taken = Some(u16::from_le_bytes([payload[1], payload[2]]));
                }
                line.payloads.push(payload);
            }
        }
        Ok(piece.len())
    }

    fn queued(&mut self) -> usize {
        self.line().queued
    }

    fn dismiss(&mut self) {
        self.line().dismissed = true;
    }

    fn discard(&mut self) {
        let mut line = self.line();
        line.discarded += 1;
        if !line.discards_later {
            line.queued = 0;
        }
    }

    fn has_discarded(&mut self) -> bool {
        std::mem::take(&mut self.line().has_discarded)
    }

    fn live(&mut self, _last_word: &[u8]) -> Watch {
        self.line().watch.unwrap_or(Watch::Kept)
    }
}

impl Opener for Bench {
    type Wire = Self;

    fn open(&mut self) -> io::Result<Self> {
        self.line().opened += 1;
        if self.line().gone {
            Err(ErrorKind::NotFound.into())
        } else {
            Ok(self.clone())
        }
    }
}

pub const FRAME: fn() -> DeviceFrame = DeviceFrame::default;

pub fn read(device: &mut LinkDevice<Bench>, now: f64) -> Reading {
    device.read(now, 1e-3, &FRAME())
}

pub fn position(reading: Reading) -> f64 {
    match reading {
        Reading::At(probe) => probe.position.x,
        other => panic!("no position but {other:?}"),
    }
}

/// The ticks in which a device hears zero that may hold a force of the session before.
pub fn let_go(device: &mut LinkDevice<Bench>) {
    for _ in 0..20 {
        device.write(DVec3::ZERO, false, &FRAME());
    }
}

pub fn greeted() -> (Bench, LinkDevice<Bench>) {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    assert!(matches!(read(&mut device, 0.0), Reading::Waiting(_)));
    assert_eq!(bench.received(), [[1, 2]]);
    bench.hello(2, 2.5);
    bench.state(65_534, 1000, 0, 1);
    (bench, device)
}
