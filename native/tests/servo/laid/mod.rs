//! A body that nobody holds, on a floor: what its ticks take, faults, and how it is laid down.

mod among;

use std::sync::Arc;

use crate::counting::counted;
use crate::scripted::{DT, OPTIONS, Table, probe};
use crate::tools_on_fingers::{ball, surface};
use glam::{DMat3, DVec3};
use palpate_servo::body::surface::Body;
use palpate_servo::device::{Fault, Reading};
use palpate_servo::pile::laid::Lying;
use palpate_servo::rest::free_body::FreeBody;
use palpate_servo::rest::placement::Placement;
use palpate_servo::rest::prop::{Prop, Support};
use palpate_servo::servo::snapshot::State;
use palpate_servo::tool::coefficients::Friction;
use palpate_servo::tool::collider::Collider;
use palpate_servo::tool::shape::{Pose, Tool};

const MASS: f64 = 0.1;
const GRAVITY: f64 = 9.81;

fn free() -> FreeBody {
    FreeBody {
        mass: MASS,
        centre: DVec3::splat(0.025),
        inertia: DMat3::from_diagonal(DVec3::splat(MASS * 0.05 * 0.05 / 6.0)),
        drag_time: 0.05,
        is_steady: false,
    }
}

/// The body on a floor at its foot.
fn prop(body: &Arc<Body>) -> Box<Lying> {
    let floor = Tool::endless(1e-3).expect("sound");
    let mut collider = Collider::new(surface(body), floor);
    collider.set_friction(Friction::of(0.5));
    Box::new(Lying::Alone(Prop {
        body: body.clone(),
        free: free(),
        placement: Placement::default(),
        gravity: DVec3::NEG_Z * GRAVITY,
        supports: vec![Support {
            collider,
            pose: Pose {
                position: DVec3::ZERO,
                rotation: DMat3::IDENTITY,
            },
        }],
    }))
}

/// A cube that was laid down; some fingers have a ball.
fn laid(with_ball: &[bool]) -> Table {
    let mut table = Table::with_fingers(crate::bodies::elastic_cube(), OPTIONS, with_ball.len());
    let surface = surface(&table.body);
    for (finger, &with_ball) in table.servo.fingers.iter_mut().zip(with_ball) {
        if with_ball {
            finger.tips.held = ball(&surface);
        }
    }
    let prop = prop(&table.body);
    assert!(table.prop.give(Some(prop)).is_ok());
    table
}

fn at(x: f64, z: f64) -> Reading {
    Reading::At(probe(DVec3::new(x, 0.025, z)))
}

/// Comes down on the middle of the cube until that is pressed, and stays.
fn press(table: &mut Table, depth: f64) {
    for step in 0..600 {
        let way = (f64::from(step) / 300.0).min(1.0);
        table.tick(at(0.025, 0.051 - (depth + 0.001) * way));
    }
}

#[test]
fn a_point_feels_what_it_presses_and_the_floor_what_both_weigh() {
    let mut table = laid(&[false]);
    press(&mut table, 0.002);
    let shot = table.tick(at(0.025, 0.048));
    assert_eq!((shot.state, shot.fault), (State::Touching, None));
    assert!(shot.contact_force.z > 0.1, "{}", shot.contact_force);
    let placement = table.published().placement;
    assert!(placement.position.z < -1e-5, "{placement:?}");
}

/// Of two fingers that go these ways, a reading of each a tick, and often touch both.
fn allocates_nothing(table: &mut Table, ways: &[[Reading; 2]]) {
    // The devices keep what they were sent, which allocates: room is made before.
    for device in &table.devices {
        device.sent.lock().unwrap().reserve(2 * ways.len());
    }
    let mut together = 0;
    let ((), allocations) = counted(|| {
        for readings in ways {
            let published = table.tick_all(DT, readings);
            let touching = published.fingers().iter();
            together += usize::from(touching.filter(|told| told.snapshot.touching).count() == 2);
        }
    });
    assert_eq!(allocations, 0);
    assert!(together > 300, "{together}");
}

#[test]
fn ticks_of_a_body_that_nobody_holds_allocate_nothing() {
    let mut table = laid(&[true, false]);
    let ways: Vec<[Reading; 2]> = (0..2000)
        .map(|tick| {
            let t = f64::from(tick) * DT;
            let depth = 0.004 * (6.0 * t).sin();
            [
                at(0.015 + 0.005 * t, 0.0625 - depth),
                at(0.035, 0.0505 - depth),
            ]
        })
        .collect();
    allocates_nothing(&mut table, &ways);
}

#[test]
fn a_fault_takes_the_force_and_lets_the_body_go() {
    let mut table = laid(&[true]);
    for step in 0..600 {
        let way = (f64::from(step) / 300.0).min(1.0);
        table.tick(at(0.025, 0.063 - 0.005 * way));
    }
    assert!(table.tick(at(0.025, 0.058)).output_force.z > 0.1);
    let pressed = table.published().placement.position.z;
    for _ in 0..200 {
        let shot = table.tick(Reading::Fault(Fault::Stale));
        assert_eq!((shot.state, shot.fault), (State::Fault, Some(Fault::Stale)));
        table.is_silent(&shot);
    }
    let let_go = table.published().placement.position.z;
    assert!(let_go > pressed + 1e-5, "{pressed} {let_go}");
    let shot = table.tick(at(0.025, 0.058));
    assert_eq!(shot.state, State::Ramping);
    assert!(shot.output_force.length() < 0.05, "{}", shot.output_force);
}

#[test]
fn what_is_laid_down_anew_is_felt_by_way_of_a_ramp() {
    let mut table = laid(&[false]);
    press(&mut table, 0.002);
    assert!(table.tick(at(0.025, 0.048)).output_force.z > 0.1);
    let prop = prop(&table.body);
    assert!(table.prop.give(Some(prop)).is_ok());
    let shot = table.tick(at(0.025, 0.048));
    assert_eq!(shot.output_force, DVec3::ZERO);
    assert_eq!(table.prop.free_old(), 2);
    // Held again, nothing moves it.
    assert!(table.prop.give(None).is_ok());
    for _ in 0..100 {
        table.tick(at(0.025, 0.06));
    }
    assert_eq!(table.published().placement, Placement::default());
}
