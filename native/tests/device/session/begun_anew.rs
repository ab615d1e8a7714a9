//! A device that begins anew: let go of what it may still hold, and spoken to as at first.

use crate::link_bench::{Bench, FRAME, greeted, let_go, read};
use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::{Device, Fault, Reading};

/// Ticks of a device that streams, from this one on: flags of the FORCE of each, None without one.
fn streamed(
    bench: &Bench,
    device: &mut LinkDevice<Bench>,
    ticks: std::ops::Range<u16>,
) -> Vec<Option<u8>> {
    ticks
        .map(|tick| {
            bench.state(tick, 1000, 0, 1);
            let reading = read(device, f64::from(tick) * 1e-3);
            let enable = matches!(reading, Reading::At(_));
            device.write(
                if enable { DVec3::X } else { DVec3::ZERO },
                enable,
                &FRAME(),
            );
            let said = bench.received();
            said.iter()
                .rfind(|payload| payload[0] == 3)
                .map(|payload| payload[9])
        })
        .collect()
}

/// HELLO said in so many silent milliseconds, each with a tick.
fn hellos_in_silence(
    bench: &Bench,
    device: &mut LinkDevice<Bench>,
    from: u16,
    ticks: u16,
) -> usize {
    let mut hellos = 0;
    for tick in from..from + ticks {
        read(device, f64::from(tick) * 1e-3);
        device.write(DVec3::ZERO, false, &FRAME());
        hellos += bench
            .received()
            .iter()
            .filter(|payload| payload[0] == 1)
            .count();
    }
    hellos
}

#[test]
fn whoever_greets_with_other_figures_is_let_go_before_there_is_force_again() {
    let (bench, mut device) = greeted();
    assert_eq!(streamed(&bench, &mut device, 1..20).last(), Some(&Some(1)));
    bench.hello(2, 30.0);
    let after = streamed(&bench, &mut device, 20..60);
    assert_eq!(after[..20], [Some(0); 20]);
    assert_eq!(after.last(), Some(&Some(1)));
}

#[test]
fn whose_clock_began_anew_out_of_sight_is_let_go_before_there_is_force_again() {
    let (bench, mut device) = greeted();
    streamed(&bench, &mut device, 1..300);
    assert_eq!(read(&mut device, 0.400), Reading::Fault(Fault::Stale));
    device.write(DVec3::ZERO, false, &FRAME());
    bench.received();
    let after: Vec<_> = (0..40_u16)
        .map(|tick| {
            bench.state_at(20_000 + 1000 * u32::from(tick), tick, 1000, 0, 1);
            let reading = read(&mut device, 0.401 + f64::from(tick) * 1e-3);
            let enable = matches!(reading, Reading::At(_));
            device.write(DVec3::ZERO, enable, &FRAME());
            bench.received().last().map(|payload| payload[9])
        })
        .collect();
    assert_eq!(after[..20], [Some(0); 20]);
    assert_eq!(after.last(), Some(&Some(1)));
}

#[test]
fn a_device_that_greeted_anew_and_then_resets_hears_hello() {
    let (bench, mut device) = greeted();
    streamed(&bench, &mut device, 1..20);
    bench.hello(2, 30.0);
    streamed(&bench, &mut device, 20..60);
    let usual = {
        let (bench, mut device) = greeted();
        streamed(&bench, &mut device, 1..60);
        hellos_in_silence(&bench, &mut device, 60, 1000)
    };
    assert!(usual > 10);
    assert_eq!(hellos_in_silence(&bench, &mut device, 60, 1000), usual);
}

#[test]
fn a_hello_with_other_figures_ends_the_session_and_one_with_the_same_does_not() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(p) if p.max_force == 2.5));
    bench.hello(2, 2.5);
    assert!(matches!(read(&mut device, 0.002), Reading::At(p) if !p.restart));
    bench.hello(2, 30.0);
    bench.state(3, 9000, 0, 1);
    assert!(matches!(read(&mut device, 0.003), Reading::Waiting(_)));
    let_go(&mut device);
    assert!(matches!(read(&mut device, 0.004), Reading::At(p) if p.restart && p.max_force == 30.0));
}

#[test]
fn a_new_session_knows_nothing_of_the_last_one() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(_)));
    bench.send(&[4, 2, 7, 0]);
    bench.hello(7, 2.5);
    assert_eq!(read(&mut device, 0.002), Reading::Fault(Fault::Protocol));
    bench.hello(2, 2.5);
    // Neither the place of 498 ms ago nor the fault of the session before.
    assert!(matches!(read(&mut device, 0.500), Reading::Waiting(_)));
    let_go(&mut device);
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
fn a_device_whose_clock_began_anew_in_a_silence_was_reset_and_is_set_down_anew() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(p) if p.restart));
    assert_eq!(read(&mut device, 0.300), Reading::Fault(Fault::Stale));
    bench.hello(2, 2.5);
    assert_eq!(read(&mut device, 0.301), Reading::Fault(Fault::Stale));
    bench.state_at(20_000, 0, -20_000, 0, 1);
    assert!(matches!(read(&mut device, 0.302), Reading::Waiting(_)));
    let_go(&mut device);
    bench.state_at(21_000, 1, -20_000, 0, 1);
    assert!(matches!(read(&mut device, 0.303), Reading::At(p) if p.restart && p.speed == 0.0));
    bench.state_at(22_000, 2, -20_000, 0, 1);
    assert!(matches!(read(&mut device, 0.304), Reading::At(p) if !p.restart));
}

#[test]
fn a_device_that_turns_out_to_be_older_in_a_session_begins_a_new_one() {
    let (bench, mut device) = greeted();
    assert!(matches!(read(&mut device, 0.001), Reading::At(_)));
    bench.is_older();
    bench.state(0, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.002), Reading::Waiting(_)));
    bench.hello(1, 2.5);
    bench.state(1, 1000, 0, 1);
    assert!(matches!(read(&mut device, 0.003), Reading::Waiting(_)));
    let_go(&mut device);
    assert!(matches!(read(&mut device, 0.004), Reading::At(_)));
}

#[test]
fn a_line_that_is_left_full_is_left_to_the_guardian() {
    for is_full in [false, true] {
        let (bench, mut device) = greeted();
        streamed(&bench, &mut device, 1..20);
        bench.line().full = is_full;
        bench.line().queued = if is_full { 500 } else { 0 };
        bench.line().discards_later = true;
        device.park();
        assert_eq!(bench.line().dismissed, !is_full);
    }
}
