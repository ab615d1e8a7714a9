//! A device that does not hear, or is heard late: found by what it says it took.

use std::collections::VecDeque;

use crate::link_bench::{Bench, DAMPING, FRAME, greeted, read};
use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::{Device, Fault, Reading};

/// Device and host at 1 kHz, force whenever the reading lets it; for each tick whether it was deaf.
fn ticks(
    bench: &Bench,
    device: &mut LinkDevice<Bench>,
    from: u32,
    count: u32,
    mut each: impl FnMut(u32),
) -> Vec<bool> {
    (from..from + count)
        .map(|tick| {
            each(tick);
            bench.state(tick as u16, 1000, 0, 1);
            let reading = read(device, f64::from(tick) * 1e-3);
            let may_push = matches!(reading, Reading::At(_));
            device.write(DVec3::X, may_push, &FRAME());
            reading == Reading::Fault(Fault::Deaf)
        })
        .collect()
}

#[test]
fn a_device_that_takes_nothing_is_deaf_within_20_ms_and_is_given_four_forces_and_zeros() {
    let (bench, mut device) = greeted();
    let before = ticks(&bench, &mut device, 1, 500, |_| {});
    assert!(before.iter().all(|deaf| !deaf));
    bench.received();
    bench.line().deaf = true;
    let deaf = ticks(&bench, &mut device, 501, 3000, |_| {});
    let first = deaf.iter().position(|deaf| *deaf).expect("deaf");
    assert!(first <= 20, "{first}");
    assert!(deaf[first..].iter().all(|deaf| *deaf));
    let said = bench.received();
    let (forces, zeros): (Vec<_>, Vec<_>) = said.iter().partition(|p| p[9] & 1 != 0);
    assert!(forces.len() <= 4, "{}", forces.len());
    assert!((1..=9).contains(&zeros.len()), "{}", zeros.len());
    bench.line().deaf = false;
    let after = ticks(&bench, &mut device, 3501, 2000, |_| {});
    let last = after.iter().rposition(|deaf| *deaf).expect("deaf");
    // Until the next zero at the latest, and a tenth of a second more.
    assert!(last < 1200, "{last}");
}

#[test]
fn a_constant_lag_of_state_is_deafness() {
    for (lag, is_deaf) in [(1, false), (15, false), (21, true), (60, true)] {
        let (bench, mut device) = greeted();
        let mut named = VecDeque::new();
        let deaf = ticks(&bench, &mut device, 1, 1000, |_| {
            // What was taken now is told so many ticks later: as if each STATE came so late.
            let taken = bench.line().taken;
            named.push_back(taken);
            bench.line().deaf = true;
            for payload in bench.received() {
                let sequence = u16::from_le_bytes([payload[1], payload[2]]);
                *named.back_mut().expect("just pushed") = Some(sequence);
            }
            if named.len() > lag {
                bench.line().taken = named.pop_front().flatten();
            }
        });
        assert_eq!(deaf[100..].iter().all(|deaf| *deaf), is_deaf, "{lag}");
        assert_eq!(deaf.iter().any(|deaf| *deaf), is_deaf, "{lag}");
    }
}

/// A device of protocol 1 that is pushed for 0.1 s.
fn older() -> (Bench, LinkDevice<Bench>) {
    let bench = Bench::default();
    let mut device = LinkDevice::open(bench.clone()).unwrap();
    read(&mut device, 0.0);
    bench.is_older();
    read(&mut device, 0.0);
    bench.hello(1, 2.5);
    ticks(&bench, &mut device, 1, 100, |_| {});
    bench.received();
    (bench, device)
}

#[test]
fn an_older_device_that_went_limp_is_given_no_force_until_it_has_answered_a_hello() {
    let (bench, mut device) = older();
    // It reads nothing, and its watchdog says so after 20 ms.
    let deaf = ticks(&bench, &mut device, 101, 3000, |tick| {
        if tick == 121 {
            bench.send(&[4, 1, 1, 0]);
        }
    });
    assert!(deaf[21..].iter().all(|deaf| *deaf));
    let said = bench.received();
    let zero = said.iter().position(|p| p[0] == 3 && p[9] == 0);
    let zero = zero.expect("let go");
    assert!(zero <= 21, "{zero}");
    let (force, hello): (Vec<_>, Vec<_>) = said[zero + 1..].iter().partition(|p| p[0] == 3);
    assert!(force.is_empty(), "nothing waits behind the zero: {force:?}");
    assert!((4..=7).contains(&hello.len()), "{}", hello.len());
    // Now it reads, and answers the next one; those before it come to nothing.
    let after = ticks(&bench, &mut device, 3101, 1500, |_| {
        if bench.received().contains(&vec![1, 1]) {
            bench.hello(1, 2.5);
        }
    });
    let last = after.iter().rposition(|deaf| *deaf).expect("deaf");
    assert!(last < 1100, "{last}");
    bench.received();
    ticks(&bench, &mut device, 4601, 10, |_| {});
    assert!(bench.received().iter().all(|p| p[0] == 3 && p[9] == 1));
}

/// An older device off the body for 5 s, which answers HELLO so many ticks later: HELLO that it was asked,
/// and whether it was ever deaf.
fn in_the_air(lag: usize) -> (usize, bool) {
    let (bench, mut device) = older();
    let mut on_the_way = VecDeque::from(vec![0; lag]);
    let (mut asked, mut deaf) = (0, false);
    for tick in 101..5101_u32 {
        bench.state(tick as u16, 1000, 0, 1);
        let reading = read(&mut device, f64::from(tick) * 1e-3);
        deaf |= reading == Reading::Fault(Fault::Deaf);
        device.write(DVec3::ZERO, matches!(reading, Reading::At(_)), &FRAME());
        let said = bench.received();
        let hellos = said.iter().filter(|payload| payload[0] == 1).count();
        if hellos > 0 && !deaf {
            // It is limp until the next FORCE, which is there at once.
            assert!(said.last().is_some_and(|payload| payload[0] == 3));
        }
        asked += hellos;
        on_the_way.push_back(hellos);
        for _ in 0..on_the_way.pop_front().unwrap_or(0) {
            bench.hello(1, 2.5);
        }
    }
    (asked, deaf)
}

#[test]
fn an_older_device_is_asked_once_a_second_while_nothing_is_felt_and_a_constant_lag_is_deafness() {
    for lag in [0, 20, 45] {
        assert_eq!(in_the_air(lag), (5, false), "{lag}");
    }
    for lag in [55, 200] {
        assert!(in_the_air(lag).1, "{lag}");
    }
}

#[test]
fn an_older_device_is_not_asked_while_it_pushes() {
    let (bench, mut device) = older();
    let deaf = ticks(&bench, &mut device, 101, 5000, |_| {});
    assert!(deaf.iter().all(|deaf| !deaf));
    assert!(bench.received().iter().all(|payload| payload[0] == 3));
}

#[test]
fn what_was_thrown_away_behind_the_back_of_a_tick_is_said_again() {
    let (bench, mut device) = older();
    bench.line().queued = 14;
    bench.line().discards_later = true;
    device.write(DVec3::ZERO, false, &FRAME());
    let said = bench.received();
    assert_eq!(said.len(), 1);
    read(&mut device, 0.101);
    assert!(bench.received().is_empty(), "not done yet");
    bench.line().has_discarded = true;
    read(&mut device, 0.102);
    assert_eq!(bench.received(), said);
    bench.line().has_discarded = true;
    read(&mut device, 0.103);
    assert!(bench.received().is_empty(), "said again already");
}

#[test]
fn a_port_that_takes_nothing_is_deafness_in_the_first_protocol_too() {
    let (bench, mut device) = older();
    bench.line().queued = 14;
    let deaf = ticks(&bench, &mut device, 101, 100, |_| bench.line().queued = 14);
    let first = deaf.iter().position(|deaf| *deaf).expect("deaf");
    assert!((19..=22).contains(&first), "{first}");
    assert!(bench.line().discarded > 0);
}

#[test]
fn a_force_says_when_the_state_was_made_that_it_answers_and_how_long_ago_it_came() {
    let (bench, mut device) = greeted();
    read(&mut device, 0.001);
    bench.received();
    bench.state_at(123_456_789, 65_535, 1000, 0, 1);
    read(&mut device, 0.002);
    device.write(DVec3::X, true, &FRAME());
    bench.state_at(123_457_789, 0, 1000, 0, 1);
    read(&mut device, 0.003);
    device.write(DVec3::X, true, &FRAME());
    // Nothing new: a zero, 5 ms after the last STATE.
    for ms in 4..=8 {
        read(&mut device, f64::from(ms) * 1e-3);
    }
    device.write(DVec3::ZERO, false, &FRAME());
    let said = bench.received();
    let answers: Vec<_> = said
        .iter()
        .map(|p| {
            let time = u32::from_le_bytes(p[10..14].try_into().unwrap());
            (time, u16::from_le_bytes(p[14..16].try_into().unwrap()))
        })
        .collect();
    assert_eq!(answers[..2], [(123_456_789, 0), (123_457_789, 0)]);
    let (time, age) = answers[2];
    assert!(time == 123_457_789 && (500..=501).contains(&age), "{age}");
}

#[test]
fn a_device_that_can_brake_is_asked_to_with_all_it_has() {
    let (bench, mut device) = greeted();
    for (brakes, flags, damping) in [(true, 2, DAMPING), (false, 0, 0)] {
        bench.state(if brakes { 65_535 } else { 0 }, 1000, 0, 1);
        read(&mut device, if brakes { 0.001 } else { 0.002 });
        bench.received();
        device.brake(brakes);
        device.write(DVec3::ZERO, false, &FRAME());
        let said = bench.received();
        assert_eq!(
            (said[0][9], &said[0][16..]),
            (flags, &damping.to_le_bytes()[..])
        );
    }
}

#[test]
fn round_trip_and_flight_are_told() {
    let (bench, mut device) = greeted();
    ticks(&bench, &mut device, 1, 500, |_| {});
    let report = device.report();
    assert!((report.round_trip.expect("told") - 1e-3).abs() < 1e-9);
    assert_eq!((report.in_flight, report.state_age), (1, Some(0.0)));
}
