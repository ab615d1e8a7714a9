//! Ten million random and mutated bytes: no panic, no message that was not sent beyond what a
//! checksum of 16 bits lets through, and each sound frame after damage is read.

use std::collections::VecDeque;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard};

use crate::damage::{Dice, Digest, frame, stream};
use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::link::codec::Decoder;
use palpate_servo::device::link::messages::{Message, parse};
use palpate_servo::device::reason;
use palpate_servo::device::serial::wire::{Opener, Wire};
use palpate_servo::device::{Device, DeviceFrame, Fault, Reading};

/// What C++ reads of the same streams (`tests/firmware/test_damage.py`).
const EXPECTED: &str = include_str!("../../../tests/vectors/damage.csv");
const STREAM_BYTES: usize = 1_000_000;

#[derive(Default)]
struct Tally {
    bytes: u64,
    sent: Digest,
    read: Digest,
    payloads: u64,
    /// Read, but not what was sent there.
    phantoms: u64,
    /// Of them, such that are messages by type and length.
    phantom_messages: u64,
    /// Sound frames that followed a delimiter, each of which was read.
    owed: u64,
    /// Of them, those right after damage.
    after_damage: u64,
    errors: (u64, u64),
}

impl Tally {
    fn line(&self, seed: u64) -> String {
        format!(
            "{seed},{},{:016x},{},{:016x},{},{},{}",
            self.bytes,
            self.sent.0,
            self.payloads,
            self.read.0,
            self.errors.0,
            self.errors.1,
            self.phantoms
        )
    }
}

fn read_stream(seed: u64) -> Tally {
    let mut tally = Tally::default();
    let mut decoder = Decoder::default();
    let (mut last_byte, mut last_sound) = (0, true);
    for chunk in stream(seed, STREAM_BYTES) {
        let owed = chunk.sound && last_byte == 0;
        let mut read = Vec::new();
        tally.bytes += chunk.bytes.len() as u64;
        tally.sent.take(&chunk.bytes);
        for &byte in &chunk.bytes {
            let Some(payload) = decoder.push(byte) else {
                continue;
            };
            tally.payloads += 1;
            tally.read.take(&[payload.len() as u8]);
            tally.read.take(payload);
            let message = parse(payload);
            if !chunk.payloads.iter().any(|sent| sent == payload) {
                tally.phantoms += 1;
                tally.phantom_messages += u64::from(message.is_some());
            }
            if let Some(Message::State(state)) = message {
                assert!(state.position().is_finite());
            }
            read.push(payload.to_vec());
        }
        if owed {
            assert_eq!(
                read, chunk.payloads,
                "a sound frame after a delimiter was lost"
            );
            tally.owed += 1;
            tally.after_damage += u64::from(!last_sound);
        }
        last_byte = chunk.bytes.last().copied().unwrap_or(last_byte);
        last_sound = chunk.sound;
    }
    let errors = decoder.errors;
    tally.errors = (errors.crc, errors.cobs + errors.oversize);
    tally
}

#[test]
fn ten_million_bytes_are_read_as_sent_and_as_cpp_reads_them() {
    let (mut bytes, mut checked, mut phantoms, mut messages) = (0, 0, 0, 0);
    let mut lines = vec!["seed,bytes,sent,payloads,read,crc_errors,malformed,phantoms".to_owned()];
    for seed in 1..=10 {
        let tally = read_stream(seed);
        lines.push(tally.line(seed));
        bytes += tally.bytes;
        checked += tally.errors.0 + tally.phantoms;
        phantoms += tally.phantoms;
        messages += tally.phantom_messages;
        assert!(tally.owed > 5_000 && tally.after_damage > 1_500);
        assert!(tally.errors.0 > 10_000 && tally.errors.1 > 2_000);
    }
    assert!(bytes >= 10_000_000);
    // Each wrong run passes the checksum with a probability of 2^-16. Five standard deviations.
    let mean = checked as f64 / 65_536.0;
    println!(
        "{phantoms} of {checked} wrong frames passed ({mean:.2} expected); {messages} messages"
    );
    assert!((phantoms as f64 - mean).abs() < 5.0 * mean.sqrt());
    assert!(messages <= phantoms);
    assert_eq!(lines.join("\n") + "\n", EXPECTED);
}

/// The device's end: the test puts bytes in, and throws away what the host says.
#[derive(Clone, Default)]
struct Bench(Arc<Mutex<Line>>);

#[derive(Default)]
struct Line {
    bytes: VecDeque<u8>,
    host: Decoder,
    /// Protocol of the host's last HELLO, and its last FORCE.
    asked: u8,
    taken: u16,
}

impl Bench {
    fn line(&self) -> MutexGuard<'_, Line> {
        self.0.lock().unwrap()
    }
}

impl Wire for Bench {
    fn waiting(&mut self) -> io::Result<usize> {
        Ok(self.line().bytes.len())
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let line = &mut self.line().bytes;
        let length = buffer.len().min(line.len());
        for (place, byte) in buffer.iter_mut().zip(line.drain(..length)) {
            *place = byte;
        }
        Ok(length)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut line = self.line();
        for &byte in bytes {
            match line.host.push(byte) {
                Some(&[1, protocol]) => line.asked = protocol,
                Some(&[3, low, high, ..]) => line.taken = u16::from_le_bytes([low, high]),
                _ => {}
            }
        }
        Ok(bytes.len())
    }
}

impl Opener for Bench {
    type Wire = Self;

    fn open(&mut self) -> io::Result<Self> {
        Ok(self.clone())
    }
}

fn hello(protocol: u8) -> Vec<u8> {
    let mut hello = vec![1, protocol];
    hello.extend([0; 16]);
    hello.push(3);
    hello.extend(2.5_f32.to_le_bytes());
    hello.extend([0; 14]);
    hello.resize(if protocol == 1 { 37 } else { 39 }, 0);
    frame(&hello)
}

/// Half a turn about z.
fn orientation(sequence: u16) -> Vec<u8> {
    let [low, high] = sequence.to_le_bytes();
    frame(&[5, low, high, 0, 0, 0, 0, 0, 0, 0xFF, 0x7F])
}

fn state(sequence: u16, micrometres: i32, taken: Option<u16>) -> Vec<u8> {
    let mut state = vec![2];
    state.extend(sequence.to_le_bytes());
    state.extend(0_u32.to_le_bytes());
    for um in [micrometres, 0, 0] {
        state.extend(um.to_le_bytes());
    }
    state.extend([0, 1]);
    if let Some(taken) = taken {
        state[20] = 5;
        state.extend(taken.to_le_bytes());
    }
    frame(&state)
}

/// Ten million bytes, a tick for every few frames, and a conversation begun anew after each break.
#[test]
fn a_device_that_sends_rubbish_is_survived_and_believed_again() {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    let mut alone = Decoder::default();
    let frame = DeviceFrame::default();
    let mut dice = Dice::new(4711);
    let (mut now, mut returns) = (0.0, 0_u64);
    let put = |decoder: &mut Decoder, bytes: &[u8]| {
        bench.line().bytes.extend(bytes);
        for &byte in bytes {
            decoder.push(byte);
        }
    };
    let mut faults = [0_u64; Fault::ALL.len()];
    for seed in 1..=10 {
        for (number, chunk) in stream(seed, STREAM_BYTES).enumerate() {
            put(&mut alone, &chunk.bytes);
            if dice.below(3) > 0 {
                continue;
            }
            now += 1e-3;
            match device.read(now, 1e-3, &frame) {
                Reading::At(probe) | Reading::Passive(probe, _) => {
                    assert!(probe.position.is_finite() && !probe.speed.is_nan());
                    assert!((probe.orientation.determinant() - 1.0).abs() < 1e-9);
                    assert!(probe.max_force.is_finite() && probe.max_force >= 0.0);
                }
                Reading::Fault(fault) => faults[fault as usize] += 1,
                Reading::Waiting(_) => {}
            }
            device.write(DVec3::X, true, &frame);
            if number % 10 == 0 {
                // Whatever came before: one delimiter, and the device is understood again. A tick
                // takes 4 KB at most, and chunks have gathered. The silence makes any sequence
                // number the next one.
                put(&mut alone, &[0]);
                while !bench.line().bytes.is_empty() {
                    device.read(now, 1e-3, &frame);
                }
                device.read(now, 1e-3, &frame);
                // And a device that was deaf has been forgotten.
                now += 0.13;
                if let Reading::Fault(fault) = device.read(now, 1e-3, &frame) {
                    faults[fault as usize] += 1;
                }
                let micrometres = number as i32;
                let asked = bench.line().asked;
                let taken = (asked == 2).then(|| bench.line().taken);
                put(&mut alone, &hello(asked));
                let sequence = dice.below(65_536) as u16;
                put(&mut alone, &orientation(sequence));
                put(&mut alone, &state(sequence, micrometres, taken));
                now += 1e-3;
                let mut reading = device.read(now, 1e-3, &frame);
                if reading == Reading::Waiting(reason::NO_STATE) {
                    // Rubbish may hold a HELLO of another device, so this one begins a new session:
                    // ticks without force tell so.
                    for _ in 0..20 {
                        device.write(DVec3::ZERO, false, &frame);
                    }
                    now += 1e-3;
                    reading = device.read(now, 1e-3, &frame);
                }
                let Reading::At(probe) = reading else {
                    panic!("not believed again after {number} chunks of {seed}: {reading:?}");
                };
                assert_eq!(
                    probe.position,
                    DVec3::new(f64::from(micrometres) * 1e-6, 0.0, 0.0)
                );
                assert!((probe.orientation * DVec3::X).distance(-DVec3::X) < 1e-12);
                returns += 1;
            }
        }
    }
    device.read(now, 1e-3, &frame);
    let report = device.report();
    let errors = (report.crc_errors, report.cobs_errors, report.oversize);
    let expected = alone.errors;
    assert_eq!(errors, (expected.crc, expected.cobs, expected.oversize));
    assert!(report.states > 5_000);
    assert!(report.unknown > 10_000 && report.device_faults > 5_000);
    assert!(report.orientations >= returns && report.orientations_unpaired > 2_000);
    assert!(report.orientations_refused > 300);
    assert!(returns > 4_000, "{returns}");
    for fault in [Fault::Stale, Fault::Protocol, Fault::Device] {
        assert!(faults[fault as usize] > 0, "{fault:?} never: {faults:?}");
    }
}
