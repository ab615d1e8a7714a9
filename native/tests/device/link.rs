//! The serial device against a wire in memory: greeting, gaps, staleness, faults, unplugging.

use crate::link_bench::{Bench, FRAME, greeted, position, read};
use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::{Device, DeviceFrame, Fault, Reading};
use palpate_servo::guardian::Watch;

#[test]
fn hello_is_repeated_until_it_is_answered() {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    for tick in 0..200 {
        let reading = read(&mut device, f64::from(tick) * 1e-3);
        assert!(matches!(reading, Reading::Waiting(_)));
        device.write(DVec3::ZERO, false, &FRAME());
    }
    assert_eq!(bench.received(), vec![vec![1, 2]; 4]);
    bench.hello(2, 2.5);
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
    // The time of the STATE that it answers, its age, no damping.
    expected.extend([0, 0, 0, 0, 0, 0, 0, 0]);
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
        [[1, 2]],
        "a device that was reset needs HELLO"
    );
    bench.state_at(65_594_000, 40, 2000, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.061) else {
        panic!("did not come back");
    };
    assert!(!probe.restart, "the little way it went unseen is swept");
    assert_eq!(device.report().lost, 0);
    assert_eq!(read(&mut device, 0.0821), Reading::Fault(Fault::Stale));
    bench.state_at(65_616_000, 41, 7000, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.083) else {
        panic!("did not come back");
    };
    assert!(probe.restart, "nobody knows how it came so far");
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
    assert_eq!(bench.received(), [[1, 2]]);
    bench.hello(2, 2.5);
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
    bench.hello(3, 2.5);
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
    bench.send(&[1, 3, 42]);
    assert_eq!(read(&mut device, 0.0), Reading::Fault(Fault::Protocol));
    assert_eq!(device.report().greeting.unwrap().protocol, 3);
}

#[test]
fn a_greeting_with_figures_that_cannot_be_gets_no_force() {
    for max_force in [f32::NAN, f32::INFINITY, -1.0] {
        let (bench, mut device) = greeted();
        assert!(matches!(read(&mut device, 0.001), Reading::At(_)));
        bench.received();
        bench.hello(2, max_force);
        bench.state(0, 0, 0, 1);
        assert!(matches!(read(&mut device, 0.002), Reading::Waiting(_)));
        is_let_go(&bench, &mut device);
        assert_eq!(device.report().greeting.unwrap().max_force, 2.5);
        assert_eq!(device.report().unknown, 1);
    }
}

/// A device that may hold a force of a session that is over hears zero without enable, in the same tick
/// and for as long as its own watchdog waits, and then nothing.
fn is_let_go(bench: &Bench, device: &mut LinkDevice<Bench>) {
    let mut sequences = Vec::new();
    for tick in 0..30 {
        device.write(DVec3::X, true, &FRAME());
        for payload in bench.received() {
            if payload[0] == 3 {
                assert_eq!(payload[3..10], [0; 7], "{tick}");
                sequences.push(u16::from_le_bytes([payload[1], payload[2]]));
            }
        }
    }
    let first = sequences[0];
    assert!(sequences.iter().copied().eq(first..first + 20));
}

#[test]
fn a_device_that_turns_out_to_be_foreign_is_let_go() {
    for foreign in [vec![1, 7], vec![1, 0, 42]] {
        let (bench, mut device) = greeted();
        read(&mut device, 0.001);
        device.write(DVec3::X, true, &FRAME());
        bench.received();
        bench.send(&foreign);
        assert_eq!(read(&mut device, 0.002), Reading::Fault(Fault::Protocol));
        is_let_go(&bench, &mut device);
    }
}

#[test]
fn a_later_state_hides_nothing_of_the_tick() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    // A jump of 30 mm, a button, a fault, no readiness: each in the first of three.
    bench.state(65_535, 31_000, 0, 1);
    bench.state(0, 31_000, 0, 1);
    bench.state(1, 31_000, 0, 1);
    let Reading::At(probe) = read(&mut device, 0.002) else {
        panic!("no position");
    };
    assert!(probe.speed > 10.0 && probe.restart);
    assert!(matches!(read(&mut device, 0.003), Reading::At(p) if !p.restart));
    bench.state(2, 31_000, 4, 1);
    bench.state(3, 31_000, 1, 1);
    bench.state(4, 31_000, 0, 1);
    assert!(matches!(read(&mut device, 0.004), Reading::At(p) if p.buttons == 5 && p.speed == 0.0));
    bench.state(5, 31_000, 0, 0);
    bench.state(6, 31_000, 0, 1);
    assert!(matches!(read(&mut device, 0.005), Reading::Passive(..)));
    bench.state(7, 31_000, 0, 3);
    bench.state(8, 31_000, 0, 1);
    assert_eq!(read(&mut device, 0.006), Reading::Fault(Fault::Device));
    // Nor does the fault hide a jump.
    bench.state(9, 31_000, 0, 3);
    bench.state(10, 61_000, 0, 3);
    assert_eq!(read(&mut device, 0.007), Reading::Fault(Fault::Device));
    bench.state(11, 61_000, 0, 1);
    assert!(matches!(read(&mut device, 0.008), Reading::At(p) if p.speed > 10.0 && p.restart));
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
    read(&mut device, 0.010);
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
    assert!(received.iter().all(|p| p[3..10] == [0; 7]));
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
    let Reading::At(probe) = device.read(0.010, 1e-3, &frame) else {
        panic!("not greeted");
    };
    assert!(probe.position.distance(DVec3::new(0.0, 2e-3, 0.5)) < 1e-12);
    bench.received();
    device.write(DVec3::Y, true, &frame);
    assert_eq!(bench.received()[0][3..5], 1000_i16.to_le_bytes());
}

#[test]
fn without_a_guardian_that_there_should_be_there_is_no_force() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(_)));
    bench.line().watch = Some(Watch::Absent);
    assert_eq!(read(&mut device, 0.002), Reading::Fault(Fault::Unguarded));
    bench.line().watch = None;
    assert!(matches!(read(&mut device, 0.003), Reading::At(_)));
}

#[test]
fn an_older_device_is_spoken_to_in_its_own_words() {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    read(&mut device, 0.0);
    assert_eq!(bench.received(), [[1, 2]]);
    bench.is_older();
    // That it is older is no fault of it.
    assert!(matches!(read(&mut device, 0.001), Reading::Waiting(_)));
    assert_eq!(bench.received(), [[1, 1]]);
    assert_eq!(device.report().device_faults, 0);
    bench.hello(1, 2.5);
    bench.state(0, 1000, 0, 1);
    assert_eq!(position(read(&mut device, 0.012)), 1e-3);
    device.write(DVec3::X, true, &FRAME());
    assert_eq!(bench.received()[0].len(), 10);
    assert_eq!(device.report().round_trip, None);
    // It says so again when the port was away.
    bench.line().gone = true;
    read(&mut device, 0.013);
    bench.line().gone = false;
    read(&mut device, 0.3);
    assert_eq!(bench.received(), [[1, 2]]);
}

#[test]
fn a_state_in_the_layout_of_another_protocol_is_unknown() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    bench.line().protocol = 1;
    bench.state(65_535, 9000, 0, 1);
    assert_eq!(position(read(&mut device, 0.002)), 1e-3);
    assert_eq!(device.report().unknown, 1);
}
