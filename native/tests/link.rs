//! The serial device against a wire in memory: greeting, gaps, staleness, faults, unplugging.

mod bodies;

use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::sync::{Arc, Mutex};

use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::link::codec::{Decoder, MAX_FRAME, encode};
use palpate_servo::device::serial::port::{Opener, Wire};
use palpate_servo::device::{Device, DeviceFrame, Fault, Reading};

#[derive(Default)]
struct Line {
    to_host: VecDeque<u8>,
    payloads: Vec<Vec<u8>>,
    decoder: Decoder,
    gone: bool,
    full: bool,
}

/// The device's end of the wire.
#[derive(Clone, Default)]
struct Bench(Arc<Mutex<Line>>);

impl Bench {
    fn line(&self) -> std::sync::MutexGuard<'_, Line> {
        self.0.lock().unwrap()
    }

    fn send(&self, payload: &[u8]) {
        let mut frame = [0; MAX_FRAME];
        let length = encode(payload, &mut frame).unwrap();
        self.line().to_host.extend(&frame[..length]);
    }

    fn hello(&self, protocol: u8, max_force: f32) {
        let mut payload = vec![1, protocol];
        payload.extend([0; 16]);
        payload.push(3);
        payload.extend(max_force.to_le_bytes());
        payload.extend([0; 14]);
        self.send(&payload);
    }

    fn state(&self, sequence: u16, micrometres: i32, buttons: u8, flags: u8) {
        self.state_at(
            u32::from(sequence) * 1000,
            sequence,
            micrometres,
            buttons,
            flags,
        );
    }

    fn state_at(&self, time_us: u32, sequence: u16, micrometres: i32, buttons: u8, flags: u8) {
        let mut payload = vec![2];
        payload.extend(sequence.to_le_bytes());
        payload.extend(time_us.to_le_bytes());
        for um in [micrometres, 0, 0] {
            payload.extend(um.to_le_bytes());
        }
        payload.extend([buttons, flags]);
        self.send(&payload);
    }

    /// A turn about z by so many quarters.
    fn turned(&self, sequence: u16, quarters: f64) {
        let half = quarters * std::f64::consts::FRAC_PI_4;
        self.quaternion(sequence, [half.cos(), 0.0, 0.0, half.sin()]);
    }

    fn quaternion(&self, sequence: u16, wxyz: [f64; 4]) {
        let mut payload = vec![5];
        payload.extend(sequence.to_le_bytes());
        for component in wxyz {
            payload.extend(((component * 32_767.0).round() as i16).to_le_bytes());
        }
        self.send(&payload);
    }

    fn received(&self) -> Vec<Vec<u8>> {
        std::mem::take(&mut self.line().payloads)
    }
}

impl Wire for Bench {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut line = self.line();
        if line.gone {
            return Ok(0);
        }
        if line.to_host.is_empty() {
            return Err(ErrorKind::WouldBlock.into());
        }
        let length = buffer.len().min(line.to_host.len());
        for (byte, arrived) in buffer.iter_mut().zip(line.to_host.drain(..length)) {
            *byte = arrived;
        }
        Ok(length)
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
                line.payloads.push(payload);
            }
        }
        Ok(piece.len())
    }
}

impl Opener for Bench {
    type Wire = Self;

    fn open(&mut self) -> io::Result<Self> {
        if self.line().gone {
            Err(ErrorKind::NotFound.into())
        } else {
            Ok(self.clone())
        }
    }
}

const FRAME: fn() -> DeviceFrame = DeviceFrame::default;

fn read(device: &mut LinkDevice<Bench>, now: f64) -> Reading {
    device.read(now, 1e-3, &FRAME())
}

fn position(reading: Reading) -> f64 {
    match reading {
        Reading::At(probe) => probe.position.x,
        other => panic!("no position but {other:?}"),
    }
}

fn greeted() -> (Bench, LinkDevice<Bench>) {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    assert!(matches!(read(&mut device, 0.0), Reading::Waiting(_)));
    assert_eq!(bench.received(), [[1, 1]]);
    bench.hello(1, 2.5);
    bench.state(65_534, 1000, 0, 1);
    (bench, device)
}

#[test]
fn hello_is_repeated_until_it_is_answered() {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    for tick in 0..200 {
        let reading = read(&mut device, f64::from(tick) * 1e-3);
        assert!(matches!(reading, Reading::Waiting(_)));
        device.write(DVec3::ZERO, false, &FRAME());
    }
    assert_eq!(bench.received(), vec![vec![1, 1]; 4]);
    bench.hello(1, 2.5);
    bench.state(0, 1000, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.2) else {
        panic!("not greeted");
    };
    assert!(probe.restart);
    assert_eq!((probe.position.x, probe.max_force), (1e-3, 2.5));
    device.write(DVec3::X, true, &FRAME());
    let mut expected = vec![3, 0, 0];
    expected.extend(1000_i16.to_le_bytes());
    expected.extend([0, 0, 0, 0, 1]);
    assert_eq!(bench.received(), [expected]);
}

#[test]
fn gaps_duplicates_and_old_states_are_counted_across_the_wrap() {
    let (bench, mut device) = greeted();
    assert_eq!(position(read(&mut device, 0.001)), 1e-3);
    bench.state(65_535, 1100, 0, 1);
    bench.state(65_535, 9000, 0, 1);
    bench.state(3, 1200, 0, 1);
    bench.state(2, 9000, 0, 1);
    assert_eq!(position(read(&mut device, 0.002)), 1.2e-3);
    let report = device.report();
    assert_eq!(report.states, 3);
    assert_eq!(
        (report.lost, report.duplicates, report.out_of_order),
        (3, 1, 1)
    );
}

#[test]
fn half_the_sequences_ahead_is_late() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    let first = 65_534_u16;
    bench.state(first.wrapping_add(0x8000), 9000, 0, 1);
    assert_eq!(position(read(&mut device, 0.002)), 1e-3);
    assert_eq!(device.report().out_of_order, 1);
    bench.state(first.wrapping_add(0x7FFF), 3000, 0, 1);
    assert_eq!(position(read(&mut device, 0.003)), 3e-3);
    let report = device.report();
    assert_eq!((report.lost, report.out_of_order), (0x7FFE, 1));
}

#[test]
fn silence_is_stale_and_the_return_takes_any_sequence() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    assert!(matches!(read(&mut device, 0.0209), Reading::At(_)));
    assert_eq!(read(&mut device, 0.0212), Reading::Fault(Fault::Stale));
    assert_eq!(read(&mut device, 0.0600), Reading::Fault(Fault::Stale));
    assert_eq!(
        bench.received(),
        [[1, 1]],
        "a device that was reset needs HELLO"
    );
    bench.state_at(65_594_000, 40, 2000, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.061) else {
        panic!("did not come back");
    };
    assert!(!probe.restart, "the way it went unseen is swept");
    assert_eq!(device.report().lost, 0);
}

#[test]
fn a_device_whose_clock_began_anew_in_a_silence_was_reset_and_is_set_down_anew() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(p) if p.restart));
    assert_eq!(read(&mut device, 0.300), Reading::Fault(Fault::Stale));
    bench.hello(1, 2.5);
    assert_eq!(read(&mut device, 0.301), Reading::Fault(Fault::Stale));
    bench.state_at(20_000, 0, -20_000, 0, 1);
    assert!(matches!(read(&mut device, 0.302), Reading::Waiting(_)));
    bench.state_at(21_000, 1, -20_000, 0, 1);
    assert!(matches!(read(&mut device, 0.303), Reading::At(p) if p.restart && p.speed == 0.0));
    bench.state_at(22_000, 2, -20_000, 0, 1);
    assert!(matches!(read(&mut device, 0.304), Reading::At(p) if !p.restart));
}

#[test]
fn a_hello_with_other_figures_ends_the_session_and_one_with_the_same_does_not() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(p) if p.max_force == 2.5));
    bench.hello(1, 2.5);
    assert!(matches!(read(&mut device, 0.002), Reading::At(p) if !p.restart));
    bench.hello(1, 30.0);
    bench.state(3, 9000, 0, 1);
    assert!(matches!(read(&mut device, 0.003), Reading::Waiting(_)));
    assert!(matches!(read(&mut device, 0.004), Reading::At(p) if p.restart && p.max_force == 30.0));
}

#[test]
fn unplugging_is_found_and_the_same_port_opened_again() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    bench.line().gone = true;
    assert_eq!(read(&mut device, 0.002), Reading::Fault(Fault::Unplugged));
    assert_eq!(read(&mut device, 0.203), Reading::Fault(Fault::Unplugged));
    bench.line().gone = false;
    assert_eq!(
        read(&mut device, 0.300),
        Reading::Fault(Fault::Unplugged),
        "slow pace"
    );
    bench.received();
    assert!(matches!(read(&mut device, 0.404), Reading::Waiting(_)));
    assert_eq!(bench.received(), [[1, 1]]);
    bench.hello(1, 2.5);
    bench.state(0, 500, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.405) else {
        panic!("did not come back");
    };
    assert!(probe.restart);
    assert_eq!(device.report().reopened, 1);
}

#[test]
fn another_version_gets_no_force() {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    bench.hello(2, 2.5);
    bench.state(0, 0, 0, 1);
    assert_eq!(read(&mut device, 0.0), Reading::Fault(Fault::Protocol));
    bench.received();
    device.write(DVec3::X, true, &FRAME());
    assert!(bench.received().is_empty());
}

#[test]
fn another_version_is_told_whatever_its_hello_looks_like() {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    bench.send(&[1, 2, 42]);
    assert_eq!(read(&mut device, 0.0), Reading::Fault(Fault::Protocol));
    assert_eq!(device.report().greeting.unwrap().protocol, 2);
}

#[test]
fn a_greeting_with_figures_that_cannot_be_gets_no_force() {
    for max_force in [f32::NAN, f32::INFINITY, -1.0] {
        let (bench, mut device) = greeted();
        assert!(matches!(read(&mut device, 0.001), Reading::At(_)));
        bench.received();
        bench.hello(1, max_force);
        bench.state(0, 0, 0, 1);
        assert!(matches!(read(&mut device, 0.002), Reading::Waiting(_)));
        device.write(DVec3::X, true, &FRAME());
        assert!(bench.received().iter().all(|payload| payload == &[1, 1]));
        assert_eq!(device.report().greeting.unwrap().max_force, 2.5);
        assert_eq!(device.report().unknown, 1);
    }
}

#[test]
fn a_new_session_knows_nothing_of_the_last_one() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(_)));
    bench.send(&[4, 2, 7, 0]);
    bench.hello(7, 2.5);
    assert_eq!(read(&mut device, 0.002), Reading::Fault(Fault::Protocol));
    bench.hello(1, 2.5);
    // Neither the place of 498 ms ago nor the fault of the session before.
    assert!(matches!(read(&mut device, 0.500), Reading::Waiting(_)));
    // Its sequence is behind that of the session before.
    bench.state(10, 3000, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.501) else {
        panic!("did not come back");
    };
    // No sweep leads here from a place that is forgotten.
    assert!(probe.restart && probe.position.x == 3e-3);
    assert_eq!(device.report().out_of_order, 0);
}

#[test]
fn faults_flags_and_buttons_of_the_device_are_passed_on() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    bench.state(65_535, 0, 4, 1);
    assert!(matches!(read(&mut device, 0.002), Reading::At(p) if p.buttons == 4));
    bench.state(0, 0, 0, 0);
    assert!(matches!(read(&mut device, 0.003), Reading::Passive(..)));
    bench.state(1, 0, 0, 3);
    assert_eq!(read(&mut device, 0.004), Reading::Fault(Fault::Device));
    bench.state(2, 0, 0, 1);
    bench.send(&[4, 7, 1, 2]);
    assert_eq!(read(&mut device, 0.005), Reading::Fault(Fault::Device));
    assert!(matches!(read(&mut device, 0.006), Reading::At(_)));
    assert_eq!(device.report().last_fault, Some((7, 513)));
    bench.send(&[9, 9]);
    read(&mut device, 0.007);
    assert_eq!(device.report().unknown, 1);
}

#[test]
fn a_jump_is_measured_as_speed() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    bench.state(65_535, 31_000, 0, 1);
    // 30 mm; the bench's clock wraps with the sequence, so it went by 1 ms.
    assert!(matches!(read(&mut device, 0.002), Reading::At(p) if (p.speed - 30.0).abs() < 1e-6));
}

#[test]
fn a_full_line_drops_new_forces_and_never_tears_a_frame() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    bench.line().full = true;
    for _ in 0..10 {
        device.write(DVec3::X, true, &FRAME());
    }
    bench.line().full = false;
    device.write(DVec3::Y, true, &FRAME());
    let received = bench.received();
    assert_eq!(received.len(), 1);
    assert_eq!(
        received[0][..3],
        [3, 0, 0],
        "no number is used up by what was not sent"
    );
    assert_eq!(device.report().unsent, 10);
    assert_eq!(bench.line().decoder.errors, Default::default());
}

#[test]
fn parking_sends_zero_without_enable() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    device.write(DVec3::X, true, &FRAME());
    bench.received();
    device.park();
    let received = bench.received();
    assert_eq!(received.len(), 3);
    assert!(received.iter().all(|p| p[3..] == [0; 7]));
    device.write(DVec3::X, true, &FRAME());
    assert!(bench.received().is_empty());
}

#[test]
fn the_frame_maps_positions_and_forces() {
    let (bench, mut device) = greeted();
    let frame = DeviceFrame {
        rotation: glam::DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2),
        translation: DVec3::new(0.0, 0.0, 0.5),
        scale: 2.0,
        epoch: 0,
    };
    let Reading::At(probe) = device.read(0.001, 1e-3, &frame) else {
        panic!("not greeted");
    };
    assert!(probe.position.distance(DVec3::new(0.0, 2e-3, 0.5)) < 1e-12);
    bench.received();
    device.write(DVec3::Y, true, &frame);
    assert_eq!(bench.received()[0][3..5], 1000_i16.to_le_bytes());
}

/// A greeted device whose first STATE, 65534, came with a quarter turn about z.
fn turned() -> (Bench, LinkDevice<Bench>) {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    bench.turned(7, 2.0);
    read(&mut device, 0.0);
    bench.received();
    bench.hello(1, 2.5);
    bench.turned(65_534, 1.0);
    bench.state(65_534, 1000, 0, 1);
    (bench, device)
}

/// Where the stylus' x axis points in the body.
fn pointing(reading: Reading) -> DVec3 {
    match reading {
        Reading::At(probe) => probe.orientation * DVec3::X,
        other => panic!("no position but {other:?}"),
    }
}

/// Paired, unpaired, refused, lost.
fn orientations(device: &LinkDevice<Bench>) -> [u64; 4] {
    let report = device.report();
    [
        report.orientations,
        report.orientations_unpaired,
        report.orientations_refused,
        report.orientations_lost,
    ]
}

#[test]
fn a_device_without_orientation_keeps_its_own_axes() {
    let (_bench, mut device) = greeted();
    assert_eq!(pointing(read(&mut device, 0.001)), DVec3::X);
    let (_bench, mut device) = greeted();
    let frame = DeviceFrame {
        rotation: glam::DMat3::from_rotation_y(std::f64::consts::FRAC_PI_2),
        ..FRAME()
    };
    let reading = device.read(0.001, 1e-3, &frame);
    assert!(pointing(reading).distance(DVec3::NEG_Z) < 1e-12);
}

#[test]
fn an_orientation_comes_with_its_state_and_is_turned_by_the_frame() {
    let (bench, mut device) = turned();
    let reading = read(&mut device, 0.001);
    assert!(pointing(reading).distance(DVec3::Y) < 1e-12);
    assert!(reading.probe().unwrap().restart);
    // The place and the turn of one moment, also when the line cuts between them.
    bench.turned(65_535, 1.01);
    let reading = read(&mut device, 0.002);
    assert_eq!(position(reading), 1e-3);
    assert!(pointing(reading).distance(DVec3::Y) < 1e-12);
    bench.state(65_535, 1001, 0, 1);
    let frame = DeviceFrame {
        rotation: glam::DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2),
        ..FRAME()
    };
    let reading = device.read(0.003, 1e-3, &frame);
    let angle = 1.01 * std::f64::consts::FRAC_PI_2;
    let expected = DVec3::new(angle.cos(), 0.0, angle.sin());
    assert!(pointing(reading).distance(expected) < 1e-4);
    // The one before HELLO was not looked at.
    assert_eq!(orientations(&device), [2, 0, 0, 0]);
}

#[test]
fn damaged_lost_and_late_orientations_leave_the_last_one_for_20_ms() {
    let (bench, mut device) = turned();
    read(&mut device, 0.001);
    for tick in 1..=19_u16 {
        let sequence = 65_534_u16.wrapping_add(tick);
        match tick % 4 {
            0 => bench.quaternion(sequence, [0.5; 4].map(|half| half * 1.02)),
            1 => bench.turned(sequence.wrapping_sub(1), 3.0),
            2 => {
                bench.turned(sequence, 3.0);
                *bench.line().to_host.back_mut().unwrap() = 1;
            }
            _ => {}
        }
        bench.state(sequence, 1000, 0, 1);
        // The hit took the delimiter, so this STATE went with it; it comes again.
        bench.state(sequence, 1000, 0, 1);
        let reading = read(&mut device, f64::from(tick + 1) * 1e-3);
        assert!(pointing(reading).distance(DVec3::Y) < 1e-12, "{tick}");
    }
    assert_eq!(orientations(&device), [1, 5, 4, 19]);
    assert_eq!(device.report().crc_errors, 5);
    bench.state(18, 1000, 0, 1);
    assert_eq!(read(&mut device, 0.0212), Reading::Fault(Fault::Stale));
    bench.state(19, 1000, 0, 1);
    assert_eq!(read(&mut device, 0.0222), Reading::Fault(Fault::Stale));
    assert!(
        !bench.received().contains(&vec![1, 1]),
        "the device is there"
    );
    bench.turned(20, 1.02);
    bench.state(20, 1000, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.0232) else {
        panic!("did not come back");
    };
    assert!(!probe.restart && probe.speed < 0.2);
    assert_eq!(device.report().lost, 0);
}

#[test]
fn an_orientation_of_a_state_that_is_not_used_is_not_used_either() {
    let (bench, mut device) = turned();
    read(&mut device, 0.001);
    for (unpaired, sequence) in [(1, 65_534), (2, 65_000)] {
        bench.turned(sequence, 2.0);
        bench.state(sequence, 9000, 0, 1);
        let reading = read(&mut device, 0.002);
        assert_eq!(position(reading), 1e-3);
        assert!(pointing(reading).distance(DVec3::Y) < 1e-12);
        assert_eq!(orientations(&device), [1, unpaired, 0, 0]);
    }
}

#[test]
fn what_was_told_before_a_break_is_not_for_the_state_after_it() {
    let told = || {
        let (bench, mut device) = turned();
        read(&mut device, 0.001);
        bench.turned(65_535, 2.0);
        read(&mut device, 0.002);
        (bench, device)
    };
    let (bench, mut device) = told();
    assert_eq!(read(&mut device, 0.3), Reading::Fault(Fault::Stale));
    assert_eq!(orientations(&device), [1, 1, 0, 0], "silence");
    bench.state_at(65_834_000, 65_535, 1000, 0, 1);
    assert_eq!(read(&mut device, 0.301), Reading::Fault(Fault::Stale));

    let (bench, mut device) = told();
    bench.line().gone = true;
    assert_eq!(read(&mut device, 0.003), Reading::Fault(Fault::Unplugged));
    assert_eq!(orientations(&device), [1, 1, 0, 0], "unplugged");
    bench.line().gone = false;
    read(&mut device, 0.3);
    bench.hello(1, 2.5);
    bench.state(65_535, 1000, 0, 1);
    assert_eq!(pointing(read(&mut device, 0.301)), DVec3::X);

    let (bench, mut device) = told();
    bench.hello(1, 30.0);
    bench.state(65_535, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.003), Reading::Waiting(_)));
    assert_eq!(orientations(&device), [1, 1, 0, 0], "another device");
    assert_eq!(pointing(read(&mut device, 0.004)), DVec3::X);
}

#[test]
fn a_device_that_begins_to_tell_its_orientation_is_set_down_anew() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(p) if p.restart));
    assert!(matches!(read(&mut device, 0.002), Reading::At(p) if !p.restart));
    bench.turned(65_535, 1.0);
    bench.state(65_535, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.003), Reading::Waiting(_)));
    let reading = read(&mut device, 0.004);
    assert!(matches!(reading, Reading::At(p) if p.restart && p.speed == 0.0));
    assert!(pointing(reading).distance(DVec3::Y) < 1e-12);
    assert!(matches!(read(&mut device, 0.005), Reading::At(p) if !p.restart));
}

#[test]
fn another_session_may_be_one_without_orientation() {
    let (bench, mut device) = turned();
    read(&mut device, 0.001);
    bench.hello(1, 30.0);
    bench.state(0, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.002), Reading::Waiting(_)));
    assert_eq!(pointing(read(&mut device, 0.003)), DVec3::X);
    bench.state(1, 1000, 0, 1);
    assert_eq!(pointing(read(&mut device, 0.0225)), DVec3::X);
}

#[test]
fn a_reset_device_tells_its_orientation_with_its_first_state() {
    let (bench, mut device) = turned();
    read(&mut device, 0.001);
    assert_eq!(read(&mut device, 0.300), Reading::Fault(Fault::Stale));
    bench.turned(0, 2.0);
    bench.state_at(20_000, 0, 0, 0, 1);
    assert!(matches!(read(&mut device, 0.301), Reading::Waiting(_)));
    let reading = read(&mut device, 0.302);
    assert!(matches!(reading, Reading::At(p) if p.restart && p.speed == 0.0));
    assert!(pointing(reading).distance(DVec3::NEG_X) < 1e-4);
    assert_eq!(orientations(&device), [2, 0, 0, 0]);
}

#[test]
fn a_jump_of_the_orientation_is_measured_as_speed() {
    let (bench, mut device) = turned();
    read(&mut device, 0.001);
    bench.turned(65_535, 1.0 + 1.0 / 90.0);
    bench.state(65_535, 1000, 0, 1);
    // A degree in a millisecond, 50 mm from the tip.
    let slow = 0.05 * 1_f64.to_radians() / 1e-3;
    assert!(
        matches!(read(&mut device, 0.002), Reading::At(p) if (p.speed - slow).abs() < 0.01 * slow)
    );
    bench.turned(0, 2.0);
    bench.state(0, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.003), Reading::At(p) if p.speed > 60.0));
}
