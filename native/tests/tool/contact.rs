//! Tools on a body, tick by tick: continuous, only pushing, bounded, without memory taken.

use crate::bodies::Dice;
use crate::counting::counted;
use crate::friction::rubbing;
use crate::on_cube::{
    LIFT, MODULUS, TOP, at, force, on_cube, own_parts, plate, rubber_cube, sphere, surface,
};
use glam::{DMat3, DVec3};
use palpate_servo::engine::lone::LoneTool;
use palpate_servo::tool::coefficients::Friction;
use palpate_servo::tool::collider::NotANumber;
use palpate_servo::tool::near_field::NearField;
use palpate_servo::tool::points::{Point, ToolSurface};
use palpate_servo::tool::shape::{Pose, Tool};
use palpate_servo::tool::slot::MOST_NEAR;
use std::f64::consts::TAU;

/// The largest jump of the force from tick to tick along a path of so many ticks.
fn largest_jump(contact: &mut LoneTool, path: impl Fn(f64) -> Pose, ticks: usize) -> (f64, f64) {
    contact.restart(&path(0.0));
    let mut last = DVec3::ZERO;
    let (mut jump, mut largest) = (0.0_f64, 0.0_f64);
    for tick in 0..=ticks {
        let now = force(contact, &path(tick as f64 / ticks as f64));
        jump = jump.max(now.distance(last));
        largest = largest.max(now.length());
        last = now;
    }
    (jump, largest)
}

/// Down on the top, over an edge of the cube and over its corner, up again.
fn round_trip(radius: f64, depth: f64) -> impl Fn(f64) -> Pose {
    move |share: f64| {
        let down = (10.0 * share).min(10.0 * (1.0 - share)).min(1.0);
        let z = TOP + radius + LIFT - (depth + LIFT) * down;
        let way = DVec3::new(0.02 + 0.04 * share, 0.025 + 0.03 * share * share, 0.0);
        let tilt = DMat3::from_rotation_x(0.4 * share) * DMat3::from_rotation_y(-0.3 * share);
        Pose {
            position: DVec3::new(way.x, way.y, z),
            rotation: tilt,
        }
    }
}

#[test]
fn jumps_over_points_edges_and_corners_shrink_with_the_step() {
    let rod = Tool::new(&[DVec3::X * -0.006, DVec3::X * 0.006], 0.01).expect("sound");
    for tool in [sphere(0.01), rod] {
        let mut contact = on_cube(tool, 3);
        let (coarse, largest) = largest_jump(&mut contact, round_trip(0.01, 0.0015), 2000);
        let (fine, _) = largest_jump(&mut contact, round_trip(0.01, 0.0015), 16_000);
        assert!(largest > 0.05, "{largest}");
        assert!(coarse < 0.1 * largest, "{coarse} of {largest}");
        assert!(fine < 0.25 * coarse, "{fine} {coarse}");
    }
}

#[test]
fn every_point_is_pushed_out_and_none_pulled() {
    for tool in [sphere(0.01), plate(0.01, 0.002)] {
        let mut contact = on_cube(tool, 3);
        let path = round_trip(contact.tool().radius(), 0.005);
        contact.restart(&path(0.0));
        for tick in 0..=3000 {
            let pose = path(f64::from(tick) / 3000.0);
            force(&mut contact, &pose);
            for slot in contact.pressed() {
                assert!(slot.force.dot(slot.normal) >= 0.0, "{tick}");
            }
            let sum: DVec3 = contact
                .nodal_forces()
                .iter()
                .map(|&(_, f)| f * MODULUS)
                .sum();
            let felt = contact.felt();
            assert!((sum + felt.force).length() <= 1e-9 * felt.force.length());
        }
        assert_eq!(contact.felt().pressed, 0);
        assert_eq!(contact.felt().force, DVec3::ZERO);
    }
}

#[test]
fn without_friction_no_work_is_left_after_a_closed_path() {
    let mut contact = on_cube(sphere(0.01), 3);
    let ticks = 10_000;
    let place = |k: usize| {
        let turn = TAU * k as f64 / f64::from(ticks);
        let round = DVec3::new(
            0.012 * turn.cos(),
            0.012 * turn.sin(),
            -0.001 * (3.0 * turn).sin(),
        );
        DVec3::new(0.03, 0.028, TOP + 0.0085) + round
    };
    let lifted = place(0) + DVec3::Z * 0.02;
    contact.restart(&at(lifted.x, lifted.y, lifted.z));
    for k in 0..=200 {
        let p = lifted.lerp(place(0), f64::from(k) / 200.0);
        force(&mut contact, &at(p.x, p.y, p.z));
    }
    for _ in 0..20 {
        force(&mut contact, &at(place(0).x, place(0).y, place(0).z));
    }
    let (mut work, mut moved) = (0.0, 0.0);
    let first = contact.felt().force;
    let mut last = first;
    for k in 1..=ticks as usize {
        let p = place(k);
        let now = force(&mut contact, &at(p.x, p.y, p.z));
        let part = (now + last).dot(p - place(k - 1)) / 2.0;
        (work, moved) = (work + part, moved + part.abs());
        last = now;
    }
    assert!(moved > 1e-4, "{moved}");
    for _ in 0..20 {
        last = force(&mut contact, &at(place(0).x, place(0).y, place(0).z));
    }
    assert!(
        last.distance(first) < 1e-7 * first.length(),
        "{last} {first}"
    );
    // What the sums of a path of straight steps are off by.
    assert!(f64::abs(work) < 1e-4 * moved, "{work} of {moved}");
}

#[test]
fn set_down_inside_it_feels_nothing_until_it_was_outside() {
    let mut contact = on_cube(sphere(0.01), 3);
    contact.restart(&at(0.025, 0.025, 0.025));
    for (z, free) in [(0.025, false), (0.049, false), (0.07, true)] {
        for _ in 0..40 {
            assert_eq!(force(&mut contact, &at(0.025, 0.025, z)), DVec3::ZERO);
        }
        assert_eq!(contact.is_free(), free, "{z}");
    }
    for _ in 0..40 {
        force(&mut contact, &at(0.025, 0.025, TOP + 0.008));
    }
    assert!(contact.felt().force.z > 0.02);
}

#[test]
fn a_jump_of_the_pose_leads_through_no_wall() {
    let mut contact = on_cube(sphere(0.004), 3);
    contact.restart(&at(0.025, 0.025, TOP + 0.006));
    // To the other side of the body in one tick.
    let mut most = 0.0_f64;
    for _ in 0..40 {
        let felt = contact
            .follow(&at(0.025, 0.025, -0.02), MODULUS)
            .expect("numbers");
        most = most.max(felt.force.z);
        assert!(felt.force.z >= -1e-9, "{felt:?}");
    }
    assert!(most > 0.1, "{most}");
}

#[test]
fn what_is_no_number_makes_no_force() {
    let mut contact = on_cube(sphere(0.01), 3);
    contact.restart(&at(0.025, 0.025, TOP + 0.012));
    for _ in 0..10 {
        force(&mut contact, &at(0.025, 0.025, TOP + 0.008));
    }
    assert!(contact.felt().pressed > 0);
    let nan = at(f64::NAN, 0.0, 0.0);
    assert_eq!(contact.follow(&nan, MODULUS), Err(NotANumber));
    assert_eq!(contact.felt().force, DVec3::ZERO);
    assert!(contact.nodal_forces().is_empty());
    for _ in 0..30 {
        force(&mut contact, &at(0.025, 0.025, TOP + 0.012));
    }
    let down = at(0.025, 0.025, TOP + 0.008);
    for modulus in [0.0, -1.0, f64::NAN] {
        assert_eq!(contact.follow(&down, modulus), Err(NotANumber));
    }
}

#[test]
fn a_tool_that_just_touches_is_not_let_go() {
    let mut contact = on_cube(sphere(0.01), 3);
    contact.restart(&at(0.025, 0.025, TOP + 0.012));
    for height in [0.01, 0.01 - 1e-15, 0.01 + 1e-15, 0.01 - 1e-13] {
        for _ in 0..6 {
            force(&mut contact, &at(0.025, 0.025, TOP + height));
        }
    }
    for _ in 0..6 {
        force(&mut contact, &at(0.025, 0.025, TOP + 0.008));
    }
    assert!(contact.felt().force.z > 0.02, "{:?}", contact.felt());
}

#[test]
fn a_tick_takes_no_memory_whatever_is_under_the_tool() {
    for friction in [0.0, 0.4] {
        takes_no_memory(rubbing(friction, friction));
    }
}

fn takes_no_memory(friction: Friction) {
    // The tool covers many times the points that can be looked at.
    let mut contact = on_cube(plate(0.04, 0.003), 4);
    contact.set_friction(friction);
    let mut dice = Dice::new(7);
    contact.restart(&at(0.025, 0.025, TOP + 0.002));
    let ((), taken) = counted(|| {
        let mut most = 0;
        for tick in 0..1000 {
            let z = TOP - 0.004 * (f64::from(tick) * 0.01).sin();
            let turn = DMat3::from_rotation_x(dice.within(-0.01, 0.01));
            let pose = Pose {
                rotation: turn,
                ..at(0.025 + dice.within(0.0, 1e-3), 0.025, z)
            };
            force(&mut contact, &pose);
            most = most.max(contact.pressed().len());
        }
        assert!(most > MOST_NEAR / 2, "{most}");
    });
    assert_eq!(taken, 0);
}

#[test]
fn surfaces_that_do_not_fit_are_refused() {
    let body = rubber_cube();
    let good = surface(&body, 1);
    let with = |change: &dyn Fn(&mut Vec<Point>, &mut NearField)| {
        let mut points = good.points().to_vec();
        let mut near = own_parts(&body, &points);
        change(&mut points, &mut near);
        (ToolSurface::new(body.clone(), points, Some(near))).map_or_else(|e| e.0, |_| "none".into())
    };
    assert_eq!(with(&|_, _| ()), "none");
    assert!(with(&|points, _| points.clear()).contains("no contact points"));
    assert!(with(&|points, _| points[3].nodes[0] = 98).contains("point 3 is on a node beyond"));
    assert!(with(&|points, _| points[2].area = 0.0).contains("point 2 at"));
    assert!(with(&|_, near| near.nodes.truncate(5)).contains("is of 5 nodes and"));
    assert!(with(&|_, near| near.points.truncate(5)).contains("and 5 contact points, the"));
    assert!(with(&|_, near| near.nodes[1].edge = 0.0).contains("not finite or cannot be"));
    assert!(
        with(&|_, near| near.points[1].own.x_axis.x = f64::NAN).contains("not finite or cannot be")
    );
    let bare = ToolSurface::new(crate::bodies::cube(), good.points().to_vec(), None);
    assert!(bare.expect_err("no compliance").0.contains("whole"));
}

#[test]
fn a_tool_in_the_air_has_no_stiffness() {
    let mut contact = on_cube(sphere(0.01), 3);
    assert_eq!(contact.felt().stiffness, DMat3::ZERO);
    force(&mut contact, &at(0.025, 0.025, TOP + LIFT));
    assert_eq!(contact.felt().stiffness, DMat3::ZERO);
    assert!(contact.follow(&at(f64::NAN, 0.0, 0.0), MODULUS).is_err());
    assert_eq!(contact.felt().stiffness, DMat3::ZERO);
}
