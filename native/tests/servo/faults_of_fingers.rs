//! Faults of one of several fingers: they lift its contact alone.

use crate::fingers::{TOP, at, settled, shots};
use crate::scripted::{DT, Table, probe, settings};
use glam::DVec3;
use palpate_servo::device::reason;
use palpate_servo::device::{Fault, Reading};
use palpate_servo::servo::snapshot::State;

#[test]
fn a_fault_of_one_lifts_its_contact_alone() {
    let places = [at(0.0134, 0.0231, 0.002), at(0.0301, 0.0262, 0.0015)];
    let (mut table, both) = settled(&places);
    let alone = settled(&places[..1]).1[0];
    let shot = shots(&table.tick_all(DT, &[places[0], Reading::Fault(Fault::Stale)]));
    assert_eq!(
        (shot[1].state, shot[1].fault),
        (State::Fault, Some(Fault::Stale))
    );
    assert_eq!((shot[0].state, shot[0].fault), (State::Touching, None));
    assert_eq!(
        *table.devices[1].sent.lock().unwrap().last().unwrap(),
        (DVec3::ZERO, false)
    );
    assert!(table.devices[0].sent.lock().unwrap().last().unwrap().1);
    // From the same tick on the other is alone.
    let change = (alone.contact_force - both[0].contact_force).length();
    assert!(shot[0].contact_force.distance(alone.contact_force) < 0.05 * change);
    // It comes back as gradually as its own force does.
    let mut last = shot[0].contact_force;
    for _ in 0..300 {
        let shot = shots(&table.tick_all(DT, &places));
        assert!(shot[0].contact_force.distance(last) < 0.1 * change);
        last = shot[0].contact_force;
    }
    // But for how the surface is held across the push, which depends on the way that led there.
    assert!(last.distance(both[0].contact_force) < 0.1 * change);
    assert_eq!(
        table.published().reports[1].faults[Fault::Stale as usize],
        1
    );
    assert_eq!(table.published().reports[0].faults, [0; Fault::ALL.len()]);
}

#[test]
fn a_device_that_wants_no_force_gives_none_to_the_others() {
    let places = [at(0.0134, 0.0231, 0.002), at(0.0301, 0.0262, 0.0015)];
    let (mut table, _) = settled(&places);
    let alone = settled(&places[..1]).1[0].contact_force;
    let limp = Reading::Passive(probe(DVec3::new(0.0301, 0.0262, TOP - 0.0015)), "why");
    let mut shot = Vec::new();
    for _ in 0..50 {
        shot = shots(&table.tick_all(DT, &[places[0], limp]));
    }
    assert_eq!(
        (shot[1].state, shot[1].nodal_forces),
        (State::Waiting, [DVec3::ZERO; 3])
    );
    assert!(shot[0].contact_force.distance(alone) < 1e-9);
}

#[test]
fn what_is_no_number_on_one_finger_is_no_force_on_the_other() {
    let places = [at(0.0134, 0.0231, 0.002), at(0.0301, 0.0262, 0.0015)];
    let (mut table, _) = settled(&places);
    let bad = Reading::At(probe(DVec3::new(f64::NAN, 0.02, 0.04)));
    for _ in 0..5 {
        let shot = shots(&table.tick_all(DT, &[places[0], bad]));
        assert_eq!(shot[1].fault, Some(Fault::Nan));
        assert_eq!((shot[0].state, shot[0].fault), (State::Touching, None));
        assert!(shot[0].contact_force.is_finite() && shot[0].contact_force.z > 0.0);
    }
}

#[test]
fn switching_off_and_stopping_silence_all() {
    let places = [at(0.0134, 0.0231, 0.002), at(0.0301, 0.0262, 0.0015)];
    let (mut table, _) = settled(&places);
    let mut off = settings();
    off.enabled = false;
    table.settings.write(off);
    let silent = |table: &Table| {
        let last = |k: usize| *table.devices[k].sent.lock().unwrap().last().unwrap();
        [last(0), last(1)] == [(DVec3::ZERO, false); 2]
    };
    for shot in shots(&table.tick_all(DT, &places)) {
        assert_eq!(
            (shot.state, shot.reason),
            (State::Disabled, reason::SWITCHED_OFF)
        );
    }
    assert!(silent(&table));
    table.settings.write(settings());
    for _ in 0..200 {
        table.tick_all(DT, &places);
    }
    assert!(!silent(&table));
    table.servo.park(None);
    assert!(silent(&table));
    for shot in shots(&table.published()) {
        assert_eq!(shot.state, State::Stopped);
    }
}
