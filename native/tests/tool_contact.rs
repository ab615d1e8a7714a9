//! Tools on a body, tick by tick: continuous, only pushing, bounded, without memory taken.

mod bodies;
mod counting;

use std::f64::consts::TAU;
use std::sync::Arc;

use bodies::Dice;
use counting::counted;
use glam::{DMat3, DVec3};
use palpate_servo::body::compliance::{Compliance, Dense, Either};
use palpate_servo::body::surface::Body;
use palpate_servo::engine::lone::LoneTool;
use palpate_servo::tool::collider::{MOST_NEAR, NotANumber};
use palpate_servo::tool::friction::Friction;
use palpate_servo::tool::near_field::{NearField, NodeField, PointField};
use palpate_servo::tool::points::{Point, ToolSurface};
use palpate_servo::tool::shape::{Pose, Tool};

const MODULUS: f64 = 1e4;
const TOP: f64 = 0.05;
/// Where paths begin and end, above where they press: clear of the body, however turned.
const LIFT: f64 = 0.01;

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose {
        position: DVec3::new(x, y, z),
        rotation: DMat3::IDENTITY,
    }
}

/// A lattice of `parts` parts an edge on every triangle of the body; shared places once.
fn surface(body: &Arc<Body>, parts: u32) -> Arc<ToolSurface> {
    let mut points: Vec<Point> = Vec::new();
    let mut faces: Vec<Vec<DVec3>> = Vec::new();
    for (t, &nodes) in body.triangles.iter().enumerate() {
        let face = body.face(t as u32);
        for i in 0..=parts {
            for j in 0..=parts - i {
                let alpha = [i, j, parts - i - j].map(|k| f64::from(k) / f64::from(parts));
                let position = face.at(alpha);
                let same = |p: &Point| p.position.distance(position) < 1e-9;
                if let Some(known) = points.iter().position(same) {
                    faces[known].push(face.normal);
                } else {
                    faces.push(vec![face.normal]);
                    points.push(Point {
                        position,
                        normal: face.normal,
                        nodes,
                        alpha,
                        area: face.area_vector.length() / 2.0,
                    });
                }
            }
        }
    }
    for (point, faces) in points.iter_mut().zip(&faces) {
        point.normal = faces.iter().sum::<DVec3>().normalize();
    }
    let near = own_parts(body, &points);
    Arc::new(ToolSurface::new(body.clone(), points, Some(near)).expect("sound"))
}

/// No half-space, but something of its own for each point, so that they are more than the nodes.
fn own_parts(body: &Body, points: &[Point]) -> NearField {
    let node = NodeField {
        normal: DVec3::Z,
        edge: 0.0125,
        softness: 1.0,
        ..NodeField::default()
    };
    let point = PointField {
        share: 0.0,
        softness: 1.0,
        own: DMat3::from_diagonal(DVec3::splat(150.0)),
    };
    NearField {
        nodes: vec![node; body.nodes.len()],
        points: vec![point; points.len()],
        believed: [0.6, 1.0],
        short: [2.2, 4.4],
        poisson_ratio: 0.3,
    }
}

/// The cube, pinned below, giving way about as rubber does: less the farther away.
fn rubber_cube() -> Arc<Body> {
    let cube = bodies::cube();
    let free: Vec<u32> = (0..cube.nodes.len() as u32)
        .filter(|&node| cube.nodes[node as usize].z > 1e-9)
        .collect();
    let between = |a: u32, b: u32| {
        let apart = cube.nodes[a as usize].distance_squared(cube.nodes[b as usize]);
        0.3 / (apart + 0.006_f64.powi(2)).sqrt()
    };
    let mut table = Vec::new();
    for &loaded in &free {
        for axis in DVec3::AXES {
            let column = |&moved: &u32| (axis * between(moved, loaded)).to_array();
            table.extend(free.iter().flat_map(column));
        }
    }
    let compliance = Dense::new(free.len(), Either::Long(table.into())).expect("n x 3 x 3n");
    let own = DMat3::from_diagonal(DVec3::splat(1.0 / between(0, 0)));
    let blocks = vec![own; cube.nodes.len()];
    let body = Body::new(cube.nodes.clone(), cube.triangles.clone(), blocks).expect("sound");
    let compliance = Arc::new(Compliance::Dense(compliance));
    Arc::new((body.with_whole_compliance(compliance, &free)).expect("it fits"))
}

fn sphere(radius: f64) -> Tool {
    Tool::new(&[DVec3::ZERO], radius).expect("sound")
}

fn plate(half: f64, rounding: f64) -> Tool {
    let corner = |k: i32| {
        let side = |bit: i32| f64::from(k >> bit & 1) * 2.0 - 1.0;
        DVec3::new(
            side(0) * half,
            side(1) * half,
            rounding + half * f64::from(k >> 2),
        )
    };
    Tool::new(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner), rounding).expect("sound")
}

fn on_cube(tool: Tool, parts: u32) -> LoneTool {
    LoneTool::new(surface(&rubber_cube(), parts), tool)
}

fn force(contact: &mut LoneTool, pose: &Pose) -> DVec3 {
    let felt = contact.follow(pose, MODULUS).expect("numbers");
    felt.force
}

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

fn rubbing(sticking: f64, slipping: f64) -> Friction {
    Friction { sticking, slipping }
}

/// Force aside over push, of the point where that is most.
fn steepest(contact: &LoneTool) -> f64 {
    let pressed = contact.pressed().iter().filter(|slot| slot.push > 0.0);
    pressed.fold(0.0, |most, slot| {
        let push = slot.force.dot(slot.normal);
        let aside = (slot.force - slot.normal * push).length();
        assert!(push > 0.0, "{slot:?}");
        f64::max(most, aside / push)
    })
}

#[test]
fn friction_holds_up_to_its_limit_and_less_once_it_slips() {
    let mut contact = on_cube(sphere(0.01), 3);
    contact.set_friction(rubbing(0.6, 0.3));
    contact.restart(&at(0.025, 0.025, TOP + 0.012));
    for tick in 0..=40 {
        force(
            &mut contact,
            &at(0.025, 0.025, TOP + 0.012 - 1e-4 * f64::from(tick)),
        );
    }
    let mut drags = Vec::new();
    for tick in 0..400 {
        let x = 0.025 + 2e-5 * f64::from(tick);
        drags.push(-force(&mut contact, &at(x, 0.025, TOP + 0.008)).x);
        assert!(steepest(&contact) <= 0.6 * (1.0 + 1e-12));
    }
    let most = drags.iter().fold(0.0, |most: f64, &drag| most.max(drag));
    assert!(
        drags[20] > 5.0 * drags[1].abs() && drags[399] < 0.8 * most,
        "{drags:?}"
    );
    assert!(
        steepest(&contact) <= 0.3 * (1.0 + 1e-12) || contact.pressed().iter().any(|s| !s.slips)
    );
    // Without friction nothing of it is left.
    contact.set_friction(Friction::default());
    for _ in 0..20 {
        force(&mut contact, &at(0.033, 0.025, TOP + 0.008));
    }
    assert!(steepest(&contact) < 1e-12);
}

#[test]
fn friction_that_is_none_makes_no_force() {
    let mut contact = on_cube(sphere(0.01), 3);
    for (sticking, slipping) in [(f64::NAN, 0.1), (0.2, f64::NAN), (0.1, 0.2), (0.3, -0.1)] {
        contact.set_friction(rubbing(sticking, slipping));
        let pose = at(0.025, 0.025, TOP + 0.012);
        assert_eq!(contact.follow(&pose, MODULUS), Err(NotANumber));
    }
}

#[test]
fn points_that_stick_count_as_stiffness_aside() {
    let mut contact = on_cube(sphere(0.01), 3);
    contact.set_friction(rubbing(5.0, 5.0));
    contact.restart(&at(0.025, 0.025, TOP + 0.012));
    for tick in 0..=60 {
        let height = 0.012 - 1e-4 * f64::from(tick.min(40));
        force(&mut contact, &at(0.025, 0.025, TOP + height));
    }
    let stiffness = contact.felt().stiffness;
    let before = contact.felt().force;
    let step = 1e-5;
    for _ in 0..20 {
        force(&mut contact, &at(0.025 + step, 0.025, TOP + 0.008));
    }
    let measured = (before.x - contact.felt().force.x) / step;
    // This body gives way alike on all sides, which none does of itself: aside it is stiffer here.
    let ratio = stiffness.x_axis.x / measured;
    assert!((0.9..1.5).contains(&ratio), "{stiffness} {measured}");
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
    assert!(with(&|points, _| points[2].area = 0.0).contains("point 2 has"));
    assert!(with(&|_, near| near.nodes.truncate(5)).contains("of another body"));
    assert!(with(&|_, near| near.points.truncate(5)).contains("other contact points"));
    assert!(with(&|_, near| near.nodes[1].edge = 0.0).contains("cannot be reckoned"));
    assert!(with(&|_, near| near.points[1].own.x_axis.x = f64::NAN).contains("cannot be reckoned"));
    let bare = ToolSurface::new(bodies::cube(), good.points().to_vec(), None);
    assert!(bare.expect_err("no compliance").0.contains("whole"));
}
