//! What the line is given, and that nothing of it is waited for.

use crate::link_bench::{Bench, FRAME, greeted, read};
use glam::DVec3;
use palpate_servo::device::Device;
use palpate_servo::device::link::LinkDevice;

/// Ticks at 1 kHz from `from` on; `states` of them bring a STATE first, the others none.
fn ticks(
    bench: &Bench,
    device: &mut LinkDevice<Bench>,
    from: u32,
    count: u32,
    states: impl Fn(u32) -> u32,
) -> Vec<usize> {
    (from..from + count)
        .map(|tick| {
            for number in 0..states(tick) {
                bench.state((tick * 4 + number) as u16, 1000, 0, 1);
            }
            read(device, f64::from(tick) * 1e-3);
            device.write(DVec3::X, true, &FRAME());
            bench.received().len()
        })
        .collect()
}

#[test]
fn an_empty_line_is_never_read() {
    let (bench, mut device) = greeted();
    // The bench itself refuses to be asked for more than there is.
    ticks(&bench, &mut device, 1, 1000, |tick| {
        u32::from(tick % 100 == 0)
    });
    assert_eq!(bench.line().reads, 11);
}

#[test]
fn each_state_is_answered_once() {
    let (bench, mut device) = greeted();
    ticks(&bench, &mut device, 1, 200, |_| 1);
    let every_tick = ticks(&bench, &mut device, 201, 100, |_| 1);
    assert!(every_tick.iter().all(|sent| *sent == 1));
    let by_twos = ticks(&bench, &mut device, 301, 100, |tick| 2 * (tick % 2));
    assert!(by_twos[1..].iter().all(|sent| *sent == 1), "{by_twos:?}");
    let seldom = ticks(&bench, &mut device, 401, 100, |tick| {
        u32::from(tick % 10 == 0)
    });
    assert!(seldom[1..].iter().sum::<usize>() <= 11, "{seldom:?}");
    // A line that had stored STATE is not given a FORCE for each of them.
    let stored = ticks(&bench, &mut device, 501, 10, |tick| {
        if tick == 501 { 4 } else { 0 }
    });
    assert!(stored.iter().sum::<usize>() <= 2, "{stored:?}");
}

#[test]
fn nothing_new_is_said_while_the_driver_has_an_old_force() {
    let (bench, mut device) = greeted();
    ticks(&bench, &mut device, 1, 100, |_| 1);
    bench.line().queued = 14;
    let held = ticks(&bench, &mut device, 101, 10, |_| 1);
    assert_eq!(held, [0; 10]);
    bench.line().queued = 0;
    assert_eq!(ticks(&bench, &mut device, 111, 1, |_| 1), [1]);
    assert_eq!(bench.line().discarded, 0);
}

#[test]
fn letting_go_throws_away_what_is_queued_and_says_zero_at_once() {
    let (bench, mut device) = greeted();
    ticks(&bench, &mut device, 1, 100, |_| 1);
    bench.line().queued = 14;
    read(&mut device, 0.101);
    device.write(DVec3::ZERO, false, &FRAME());
    assert_eq!(bench.line().discarded, 1);
    let said = bench.received();
    assert_eq!(said.len(), 1);
    assert_eq!(said[0][3..10], [0; 7]);
    // Where nothing is queued nothing is thrown away.
    ticks(&bench, &mut device, 102, 10, |_| 1);
    device.write(DVec3::ZERO, false, &FRAME());
    assert_eq!(bench.line().discarded, 1);
}

#[test]
fn a_zero_that_does_not_fit_is_the_next_word() {
    let (bench, mut device) = greeted();
    ticks(&bench, &mut device, 1, 100, |_| 1);
    bench.line().full = true;
    ticks(&bench, &mut device, 101, 5, |_| 1);
    device.write(DVec3::ZERO, false, &FRAME());
    bench.line().full = false;
    bench.state(5000, 1000, 0, 1);
    read(&mut device, 0.107);
    device.write(DVec3::X, true, &FRAME());
    let said = bench.received();
    assert_eq!(said[0][3..10], [0; 7]);
    assert_eq!(bench.line().decoder.errors, Default::default());
}
