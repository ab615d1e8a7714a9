//! A body on another one: what its ticks take, and faults.

use super::{GRAVITY, allocates_nothing, free};
use crate::scripted::{DT, OPTIONS, Table, probe};
use crate::tools_on_fingers::{ball, surface};
use glam::{DMat3, DQuat, DVec3};
use palpate_servo::device::{Fault, Reading};
use palpate_servo::pile::among::Among;
use palpate_servo::pile::laid::Lying;
use palpate_servo::pile::member::Member;
use palpate_servo::pile::obstacle::Obstacle;
use palpate_servo::pile::piled::Pile;
use palpate_servo::rest::placement::Placement;
use palpate_servo::servo::snapshot::State;
use palpate_servo::tool::points::touchable::Touchable;
use palpate_servo::tool::shape::{Pose, Tool};

const HIGH: f64 = 0.05;

/// Two cubes on a floor, one on the other; fingers with a ball touch the upper one.
fn stacked(fingers: usize) -> Table {
    let mut table = Table::with_fingers(crate::bodies::elastic_cube(), OPTIONS, fingers);
    let surface = surface(&table.body);
    for finger in &mut table.servo.fingers {
        finger.tips.held = ball(&surface);
    }
    let members = [HIGH + 1e-5, 0.0].map(|height| {
        let placement = Placement {
            position: DVec3::Z * height,
            rotation: DQuat::IDENTITY,
        };
        Member::new(
            Touchable::new(surface.clone(), None),
            1e4,
            Some(free()),
            placement,
        )
    });
    let floor = Pose {
        position: DVec3::ZERO,
        rotation: DMat3::IDENTITY,
    };
    let floor = Obstacle::new(Tool::endless(1e-3).expect("sound"), floor, 0.5, false);
    let pile = Pile::new(members.into(), vec![floor], DVec3::NEG_Z * GRAVITY, 0.5);
    let lying = Box::new(Lying::Among(Among::new(pile)));
    // A copy has the same memory, as when Python lays it.
    assert!(table.prop.give(Some(lying.clone())).is_ok());
    table
}

fn at(x: f64, z: f64) -> Reading {
    Reading::At(probe(DVec3::new(x, 0.025, HIGH + z)))
}

/// Comes down on the middle of the upper cube.
fn press(table: &mut Table) {
    for step in 0..600 {
        let way = (f64::from(step) / 300.0).min(1.0);
        table.tick(at(0.025, 0.063 - 0.005 * way));
    }
}

#[test]
fn ticks_of_two_bodies_allocate_nothing() {
    let mut table = stacked(2);
    let ways: Vec<[Reading; 2]> = (0..2000)
        .map(|tick| {
            let t = f64::from(tick) * DT;
            let depth = 0.004 * (6.0 * t).sin();
            [
                at(0.015, 0.0625 - depth),
                at(0.035 + 0.005 * t, 0.0625 - depth),
            ]
        })
        .collect();
    allocates_nothing(&mut table, &ways);
}

#[test]
fn a_fault_takes_the_force_and_lets_both_go() {
    let mut table = stacked(1);
    press(&mut table);
    assert!(table.tick(at(0.025, 0.058)).output_force.z > 0.1);
    let heights = |table: &mut Table| {
        let published = table.published();
        assert_eq!(published.other_count, 1);
        [published.placement, published.others[0]].map(|placement| placement.position.z)
    };
    let pressed = heights(&mut table);
    for _ in 0..200 {
        let shot = table.tick(Reading::Fault(Fault::Stale));
        assert_eq!((shot.state, shot.fault), (State::Fault, Some(Fault::Stale)));
        table.is_silent(&shot);
    }
    let let_go = heights(&mut table);
    for (let_go, pressed) in let_go.into_iter().zip(pressed) {
        assert!(let_go > pressed + 1e-6, "{pressed} {let_go}");
    }
    let shot = table.tick(at(0.025, 0.058));
    assert_eq!(shot.state, State::Ramping);
    assert!(shot.output_force.length() < 0.05, "{}", shot.output_force);
}

#[test]
fn what_is_no_number_gives_no_force() {
    let mut table = stacked(1);
    press(&mut table);
    assert!(table.tick(at(0.025, 0.058)).output_force.z > 0.1);
    let nowhere = probe(DVec3::splat(f64::NAN));
    let shot = table.tick(Reading::At(nowhere));
    assert_eq!(shot.fault, Some(Fault::Nan));
    table.is_silent(&shot);
    for _ in 0..100 {
        table.tick(at(0.025, 0.063));
    }
    for step in 0..300 {
        table.tick(at(0.025, 0.063 - 0.005 * f64::from(step) / 300.0));
    }
    let shot = table.tick(at(0.025, 0.058));
    assert!(shot.output_force.z > 0.1, "{}", shot.output_force);
}
