//! Orientations of the serial device: each with its STATE, and what holds when one is missing.

use crate::link_bench::{Bench, FRAME, greeted, let_go, position, read};
use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::{Device, DeviceFrame, Fault, Reading};

/// A greeted device whose first STATE, 65534, came with a quarter turn about z.
fn turned() -> (Bench, LinkDevice<Bench>) {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    bench.turned(7, 2.0);
    read(&mut device, 0.0);
    bench.received();
    bench.hello(2, 2.5);
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
        !bench.received().contains(&vec![1, 2]),
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
    bench.hello(2, 2.5);
    bench.state(65_535, 1000, 0, 1);
    assert_eq!(pointing(read(&mut device, 0.301)), DVec3::X);

    let (bench, mut device) = told();
    bench.hello(2, 30.0);
    bench.state(65_535, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.003), Reading::Waiting(_)));
    assert_eq!(orientations(&device), [1, 1, 0, 0], "another device");
    let_go(&mut device);
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
    bench.hello(2, 30.0);
    bench.state(0, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.002), Reading::Waiting(_)));
    let_go(&mut device);
    bench.state(1, 1000, 0, 1);
    assert_eq!(pointing(read(&mut device, 0.003)), DVec3::X);
    bench.state(2, 1000, 0, 1);
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
    let_go(&mut device);
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
