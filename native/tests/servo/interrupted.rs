//! Interruptions in the middle of a press: the thread held up, a device too fast, another body.

use std::sync::Arc;

use crate::scripted::{ABOVE, DT, OPTIONS, PRESSED, Scripted, Table, probe, settings};
use glam::DVec3;
use palpate_servo::device::reason;
use palpate_servo::device::{Fault, Probe, Reading};
use palpate_servo::servo::settings::Settings;
use palpate_servo::servo::snapshot::{Published, State};
use palpate_servo::servo::thread::Running;
use triple_buffer::triple_buffer;

#[test]
fn a_gap_between_ticks_gives_no_force_in_the_tick_after_it_and_then_a_ramp() {
    for gap in [0.0205, 1.0, 8.0 * 3600.0] {
        let mut table = Table::pressing();
        let shot = table.tick_after(gap, Reading::At(probe(PRESSED)));
        assert_eq!(
            (shot.state, shot.fault),
            (State::Fault, Some(Fault::Suspended))
        );
        table.is_silent(&shot);
        // As long as what was stored on the line may be old.
        for _ in 0..20 {
            let shot = table.press();
            assert_eq!(shot.fault, Some(Fault::Suspended));
            table.is_silent(&shot);
        }
        assert_eq!(table.ramps(), "after suspended");
        assert_eq!(table.counted(Fault::Suspended), 1);
    }
}

#[test]
fn a_gap_that_the_device_bears_too_changes_nothing() {
    let mut table = Table::pressing();
    let shot = table.tick_after(0.0195, Reading::At(probe(PRESSED)));
    assert_eq!(shot.state, State::Touching);
    assert_eq!(shot.output_force, shot.contact_force);
    assert_eq!(table.counted(Fault::Suspended), 0);
}

#[test]
fn a_gap_while_there_is_no_force_is_no_fault() {
    let mut table = Table::pressing();
    table.settings.write(Settings {
        enabled: false,
        ..settings()
    });
    table.press();
    let shot = table.tick_after(1.0, Reading::At(probe(PRESSED)));
    assert_eq!((shot.state, shot.fault), (State::Disabled, None));
    table.settings.write(settings());
    table.ramps();
}

#[test]
fn a_suspension_is_named_whatever_the_device_says_of_it() {
    for consequence in [Fault::Stale, Fault::Device] {
        let mut table = Table::pressing();
        let shot = table.tick_after(1.0, Reading::Fault(consequence));
        assert_eq!(shot.fault, Some(Fault::Suspended));
        let shot = table.tick(Reading::Fault(consequence));
        assert_eq!(shot.fault, Some(consequence));
        table.is_silent(&shot);
    }
}

#[test]
fn holes_in_what_the_line_had_stored_are_not_too_fast() {
    let mut table = Table::pressing();
    table.tick_after(1.0, Reading::At(probe(PRESSED)));
    let hole = Reading::At(Probe {
        speed: 30.0,
        ..probe(PRESSED)
    });
    for _ in 0..10 {
        let shot = table.tick(hole);
        assert_eq!(shot.fault, Some(Fault::Suspended));
        table.is_silent(&shot);
    }
    for _ in 0..20 {
        assert_eq!(table.press().fault, Some(Fault::Suspended));
    }
    assert_eq!(table.ramps(), "after suspended");
    assert_eq!(table.counted(Fault::TooFast), 0);
}

#[test]
fn a_starved_thread_gives_no_force_between_its_gaps() {
    let mut table = Table::pressing();
    for _ in 0..20 {
        for seconds in [0.03, DT, DT, 0.005] {
            let shot = table.tick_after(seconds, Reading::At(probe(PRESSED)));
            table.is_silent(&shot);
        }
    }
    assert_eq!(table.counted(Fault::Suspended), 1, "one episode");
}

#[test]
fn a_device_that_is_too_fast_gets_no_force_until_it_is_calm() {
    let mut table = Table::pressing();
    let at = |speed| {
        Reading::At(Probe {
            speed,
            ..probe(ABOVE)
        })
    };
    for speed in [2.1, 1.9, 1.1, 2.0001, 1.5] {
        let shot = table.tick(at(speed));
        assert_eq!(shot.fault, Some(Fault::TooFast), "{speed}");
        table.is_silent(&shot);
    }
    for tick in 0..100 {
        let shot = table.tick(at(0.9));
        assert_eq!(shot.fault, Some(Fault::TooFast), "{tick}");
        table.is_silent(&shot);
    }
    assert_eq!(table.counted(Fault::TooFast), 1);
    let shot = table.tick(at(0.9));
    assert_eq!(
        (shot.state, shot.reason),
        (State::Ramping, "after too fast")
    );
    let shot = table.press();
    let gain = shot.output_force.length() / shot.contact_force.length();
    assert!((gain - 0.02).abs() < 1e-9, "{gain}");
}

#[test]
fn a_jump_of_metres_never_becomes_a_depth() {
    let mut table = Table::pressing();
    let lost = DVec3::new(0.02, 0.03, 0.001);
    let jump = Probe {
        speed: 46.0,
        ..probe(lost)
    };
    let shot = table.tick(Reading::At(jump));
    assert_eq!(shot.fault, Some(Fault::TooFast));
    table.is_silent(&shot);
    for _ in 0..1000 {
        let shot = table.tick(Reading::At(probe(lost)));
        assert_eq!(shot.output_force, DVec3::ZERO);
        assert_eq!(shot.contact_force, DVec3::ZERO);
    }
    let shot = table.tick(Reading::At(probe(lost)));
    assert_eq!((shot.state, shot.reason), (State::Free, reason::INSIDE));
    table.presses();
}

#[test]
fn a_body_replaced_while_touched_gives_no_force_and_then_a_ramp() {
    let mut table = Table::pressing();
    let (body, number) = (crate::bodies::inner_corner(), 1);
    assert_eq!(table.hand.give(body), number);
    table.settings.write(Settings {
        young_modulus: 2e4,
        ..settings()
    });
    // Not settled: as long as the settings may still be on their way.
    for _ in 0..3 {
        let shot = table.press();
        assert_eq!(
            (shot.state, shot.reason, shot.body),
            (State::Ramping, reason::BODY_REPLACED, number)
        );
        table.is_silent(&shot);
    }
    table.hand.settle();
    for _ in 0..300 {
        let shot = table.press();
        assert_eq!(shot.output_force, DVec3::ZERO, "set down inside");
    }
    assert_eq!(table.press().reason, reason::INSIDE);
    table.presses();
}

#[test]
fn a_body_that_comes_up_to_a_probe_outside_of_it_is_felt_with_a_ramp() {
    let mut table = Table::pressing();
    table.hand.give(crate::bodies::wall(0.04));
    table.hand.settle();
    let shot = table.press();
    assert_eq!(
        (shot.state, shot.reason),
        (State::Ramping, reason::BODY_REPLACED)
    );
    table.is_silent(&shot);
    let inside = DVec3::new(0.02, 0.03, 0.035);
    let shot = table.tick(Reading::At(probe(inside)));
    assert_eq!((shot.state, shot.limited), (State::Ramping, "ramp"));
    let gain = shot.output_force.length() / shot.contact_force.length();
    assert!((gain - 0.01).abs() < 1e-9, "{gain}");
}

#[test]
fn the_old_body_is_freed_by_whoever_brought_the_new_one() {
    let old = crate::bodies::cube();
    let kept = Arc::downgrade(&old);
    let running = Running::start(
        old,
        vec![Box::new(Scripted::above())],
        OPTIONS,
        settings(),
        10,
        0,
    )
    .unwrap();
    for _ in 0..20 {
        let new = crate::bodies::inner_corner();
        let weak = Arc::downgrade(&new);
        running.set_body(new, settings());
        assert_eq!(kept.strong_count(), 0);
        // Three places of the exchange and the hand; one more while a tick runs.
        assert!((4..=5).contains(&weak.strong_count()));
    }
    assert_eq!(running.published().first().snapshot.body, 20);
    running.paced().stop();
}

#[test]
fn a_reader_that_holds_its_end_holds_up_nobody_and_then_sees_the_newest() {
    let mut table = Table::pressing();
    let (_, nobody) = triple_buffer(&Published::default());
    let mut reader = std::mem::replace(&mut table.snapshots, nobody);
    let held = reader.read();
    let then = *held;
    // Were the thread to wait for a reader, or for room in the ring, this would never end.
    for _ in 0..1000 {
        table.press();
    }
    assert_eq!(*held, then, "nothing changes under a reader's eyes");
    let newest = *reader.read();
    assert_eq!(
        newest.first().snapshot.tick,
        then.first().snapshot.tick + 1000
    );
    assert_eq!(newest.samples_lost, newest.first().snapshot.tick - 10);
    assert_eq!(newest.first().snapshot.state, State::Touching);
}
