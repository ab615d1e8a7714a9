//! Several fingers on one body: coupled by (10), felt through the body, coming and going without a
//! jump, and each with faults of its own.

use crate::scripted::{ABOVE, DT, OPTIONS, Table, probe, settings};
use glam::{DMat3, DVec3};
use palpate_servo::body::surface::Body;
use palpate_servo::contact::cones::{Blocks, Cone, MAX_FINGERS, Members, Vectors, solve_distinct};
use palpate_servo::contact::ground::Ground;
use palpate_servo::contact::touch::{ContactMode, touch};
use palpate_servo::control::coupling::Coupling;
use palpate_servo::device::{Probe, Reading};
use palpate_servo::fingers::press::{Press, Reaction};
use palpate_servo::fingers::several::Several;
use palpate_servo::proxy::SurfacePoint;
use palpate_servo::servo::settings::FingerSettings;
use palpate_servo::servo::snapshot::{Published, Snapshot, State};

pub const TOP: f64 = 0.05;

pub fn at(x: f64, y: f64, depth: f64) -> Reading {
    Reading::At(probe(DVec3::new(x, y, TOP - depth)))
}

pub fn shots(published: &Published) -> Vec<Snapshot> {
    let told = published.fingers().iter();
    told.map(|told| told.snapshot).collect()
}

/// Fingers that came down from above to these places, at rest there, at full force.
pub fn settled(readings: &[Reading]) -> (Table, Vec<Snapshot>) {
    let mut table = Table::with_fingers(crate::bodies::elastic_cube(), OPTIONS, readings.len());
    let above = |lift: f64| -> Vec<Reading> {
        let lifted = |reading: &Reading| match reading {
            Reading::At(probe) => Reading::At(Probe {
                position: probe.position + DVec3::Z * lift,
                ..*probe
            }),
            other => *other,
        };
        readings.iter().map(lifted).collect()
    };
    for step in (0..=400).rev() {
        table.tick_all(DT, &above(2e-5 * f64::from(step)));
    }
    let mut last = table.published();
    for _ in 0..200 {
        last = table.tick_all(DT, readings);
    }
    (table, shots(&last))
}

#[test]
pub fn two_fingers_on_nodes_press_as_equation_10_says() {
    let body = crate::bodies::elastic_cube();
    let on_node = |triangle: u32| SurfacePoint {
        triangle,
        alpha: [1.0, 0.0, 0.0],
    };
    let holds = [on_node(40), on_node(90)];
    let u = holds.map(|hold| body.face(hold.triangle).normal * -1e-3);
    let mut presses = [None; MAX_FINGERS];
    (presses[0], presses[1]) = (press(holds[0], u[0]), press(holds[1], u[1]));
    let answers = Several::default()
        .solve(&[on(&body)], &presses, &Reaction::default())
        .expect("sound");
    let node = |k: usize| body.triangles[holds[k].triangle as usize][0];
    assert_ne!(node(0), node(1));
    for (own, other) in [(0, 1), (1, 0)] {
        let block = |a, b| body.block(node(a), node(b)).expect("a whole body");
        let moved = block(own, own) * answers[own].force + block(own, other) * answers[other].force;
        assert!(moved.distance(u[own]) < 1e-15, "{moved} {}", u[own]);
        assert!(answers[own].force.length() > 0.0);
    }
}

#[test]
pub fn each_surface_point_is_where_its_finger_is_and_each_feels_the_other() {
    let places = [at(0.0134, 0.0231, 0.002), at(0.0301, 0.0262, 0.0015)];
    let (table, both) = settled(&places);
    for shot in &both {
        assert!(shot.surface_point.expect("it knows").distance(shot.probe) < 1e-12);
    }
    for (k, place) in places.iter().enumerate() {
        let alone = settled(&[*place]).1[0];
        // Drawn along by the other, the surface resists less.
        let (alone, together) = (alone.contact_force.length(), both[k].contact_force.length());
        assert!(
            together < 0.9 * alone && together > 0.2 * alone,
            "{together} {alone}"
        );
    }
    drop(table);
}

#[test]
pub fn in_the_papers_mode_each_feels_as_if_it_were_alone() {
    let places = [at(0.0134, 0.0231, 0.002), at(0.0301, 0.0262, 0.0015)];
    let (mut table, _) = settled(&places);
    let mut paper = settings();
    paper.feel.mode = ContactMode::Paper;
    table.settings.write(paper);
    let mut last = Published::default();
    for _ in 0..100 {
        last = table.tick_all(DT, &places);
    }
    for shot in shots(&last) {
        let (triangle, alpha) = shot.hold.expect("it touches");
        let u = shot.probe - shot.proxy;
        let alone = touch(&table.body, ContactMode::Paper, triangle, alpha, u, 1e4);
        assert_eq!(shot.contact_force, alone.force);
    }
}

/// The largest change of any force in a tick over a way of both fingers, by so many ticks.
pub fn largest_jump(ticks: u32, way: impl Fn(f64) -> [Reading; 2]) -> f64 {
    let mut table = Table::with_fingers(crate::bodies::elastic_cube(), OPTIONS, 2);
    let (mut last, mut largest) = ([DVec3::ZERO; 2], 0.0_f64);
    for tick in 0..=ticks {
        let shots = shots(&table.tick_all(DT, &way(f64::from(tick) / f64::from(ticks))));
        let felt = [shots[0].contact_force, shots[1].contact_force];
        for (shot, (now, before)) in shots.iter().zip(felt.iter().zip(last)) {
            largest = largest.max(now.distance(before));
            assert!(now.length() < 100.0, "{now}");
            // Never a pull: what is felt leads out of the body.
            assert!(now.z >= 0.0, "{now} {shot:?}");
        }
        last = felt;
    }
    largest
}

pub fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[test]
pub fn fingers_come_go_and_pass_each_other_without_a_jump() {
    // One presses; the other comes down beside it, passes through its place, and leaves.
    let over = |y: f64| {
        move |t: f64| {
            let down = 0.002 * (smooth(8.0 * t) - smooth(8.0 * t - 7.0)) - 5e-4;
            let x = 0.012 + 0.026 * smooth(1.5 * t - 0.25);
            [at(0.0234, 0.0231, 0.0018), at(x, y, down)]
        }
    };
    // Pressed out at the place where the other comes: from above, while one pushes from the side.
    let bulge = |t: f64| {
        let down = 0.0012 * smooth(2.0 * t) - 0.001;
        let side = DVec3::new(0.003 * smooth(4.0 * t) - 0.001, 0.02, 0.03);
        [Reading::At(probe(side)), at(0.0302, 0.0213, down)]
    };
    for (name, jumps) in [
        (
            "through",
            [8_000, 32_000].map(|n| largest_jump(n, over(0.0231))),
        ),
        (
            "beside",
            [8_000, 32_000].map(|n| largest_jump(n, over(0.0262))),
        ),
        ("bulge", [8_000, 32_000].map(|n| largest_jump(n, bulge))),
    ] {
        println!("{name}: {jumps:?} N");
        assert!(
            jumps[0] < 0.05 && jumps[1] < 0.4 * jumps[0],
            "{name}: {jumps:?}"
        );
    }
}

fn on(body: &Body) -> Ground<'_> {
    Ground {
        body,
        number: 0,
        young_modulus: 1.0,
        mobility: None,
        creep: Default::default(),
    }
}

pub fn press(hold: SurfacePoint, displacement: DVec3) -> Option<Press> {
    Some(Press {
        body: 0,
        hold,
        touches: true,
        displacement,
        push: displacement,
        cone: None,
        most_stiffness: f64::INFINITY,
        presence: 1.0,
        remembered: DVec3::ZERO,
        carried: DVec3::ZERO,
    })
}

#[test]
pub fn what_one_does_to_the_other_the_other_does_to_the_one() {
    let body = crate::bodies::elastic_cube();
    let mut dice = crate::bodies::Dice::new(11);
    for _ in 0..50 {
        let mut hold = || SurfacePoint {
            triangle: dice.below(body.triangles.len()) as u32,
            alpha: [0.5, 0.2, 0.3],
        };
        let holds = [hold(), hold(), hold()];
        let push = holds.map(|hold| body.face(hold.triangle).normal * -1e-3);
        let forces = |change: usize, by: DVec3| {
            let mut presses = [None; MAX_FINGERS];
            for k in 0..3 {
                let by = if k == change { by } else { DVec3::ZERO };
                presses[k] = press(holds[k], push[k] + by);
            }
            let answers = Several::default().solve(&[on(&body)], &presses, &Reaction::default());
            answers.expect("a whole body").map(|answer| answer.force)
        };
        let still = forces(3, DVec3::ZERO);
        if still[..3].contains(&DVec3::ZERO) {
            continue;
        }
        let derivative = |change: usize, felt: usize| {
            let column = |axis: DVec3| (forces(change, axis * 1e-9)[felt] - still[felt]) * 1e9;
            DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
        };
        let (one, other) = (derivative(0, 1), derivative(1, 0).transpose());
        assert!(
            one.abs_diff_eq(other, 1e-4 * derivative(0, 0).x_axis.x.abs()),
            "{one} {other}"
        );
    }
}

#[test]
pub fn fingers_on_one_place_share_what_one_would_feel() {
    let body = crate::bodies::elastic_cube();
    let alone = {
        let mut presses = [None; MAX_FINGERS];
        let hold = SurfacePoint {
            triangle: 100,
            alpha: [0.3, 0.3, 0.4],
        };
        presses[0] = press(hold, body.face(100).normal * -1e-3);
        Several::default()
            .solve(&[on(&body)], &presses, &Reaction::default())
            .expect("sound")[0]
            .force
    };
    for alpha in [
        [0.3, 0.3, 0.4],
        [0.3 + 1e-9, 0.3, 0.4 - 1e-9],
        [0.301, 0.299, 0.4],
    ] {
        for count in 2..=MAX_FINGERS {
            let mut presses = [None; MAX_FINGERS];
            for (k, one) in presses.iter_mut().take(count).enumerate() {
                let alpha = if k == 0 { [0.3, 0.3, 0.4] } else { alpha };
                *one = press(
                    SurfacePoint {
                        triangle: 100,
                        alpha,
                    },
                    body.face(100).normal * -1e-3,
                );
            }
            let answers = Several::default()
                .solve(&[on(&body)], &presses, &Reaction::default())
                .expect("sound");
            let sum: DVec3 = answers.iter().map(|answer| answer.force).sum();
            assert!(
                sum.distance(alone) < 0.03 * alone.length(),
                "{count}: {sum} {alone}"
            );
            for answer in &answers[..count] {
                assert!(answer.force.dot(alone) >= 0.0, "{count}: a pull");
            }
        }
    }
}

#[test]
pub fn a_device_sees_no_more_than_its_limit_also_while_the_other_holds_the_body() {
    // Two places close to each other: held by the other, each is much firmer than alone.
    let firm = Reading::At(Probe {
        max_force: f64::INFINITY,
        ..probe(DVec3::new(0.0262, 0.0231, TOP - 0.0015))
    });
    let place = |depth: f64| [at(0.0231, 0.0231, depth), firm];
    let (mut table, _) = settled(&place(0.0015));
    let mut limited = settings();
    limited.fingers = [FingerSettings {
        coupling: Coupling {
            stiffness: 60.0,
            damping: 0.0,
            passivity_control: false,
        },
        ..FingerSettings::default()
    }; MAX_FINGERS];
    let mut felt = |settings, depth: f64| {
        table.settings.write(settings);
        let mut last = Vec::new();
        for _ in 0..50 {
            last = shots(&table.tick_all(DT, &place(depth)));
        }
        let nodal: DVec3 = last[0].nodal_forces.iter().sum();
        assert!((nodal + last[0].output_force).length() < 1e-9);
        last[0].output_force
    };
    let slope = |pair: [DVec3; 2]| pair[0].distance(pair[1]) / 1e-5;
    let whole = slope([0.0015, 0.00151].map(|depth| felt(settings(), depth)));
    let seen = slope([0.0015, 0.00151].map(|depth| felt(limited, depth)));
    assert!(
        whole > 100.0 && seen <= 60.0 * (1.0 + 1e-6) && seen > 20.0,
        "{whole} {seen}"
    );
}

#[test]
pub fn two_that_are_set_down_and_touch_at_once_stay_in_touch() {
    let mut table = Table::with_fingers(crate::bodies::elastic_cube(), OPTIONS, 2);
    let pinch = |depth: f64, restart: bool| {
        let side = |x: f64| {
            let mut probe = probe(DVec3::new(x, 0.02, 0.03));
            probe.restart = restart;
            Reading::At(probe)
        };
        [side(depth), side(0.05 - depth)]
    };
    table.tick_all(DT, &pinch(-1e-4, true));
    let mut last = Vec::new();
    for _ in 0..400 {
        last = shots(&table.tick_all(DT, &pinch(2e-3, false)));
    }
    for (shot, outward) in last.iter().zip([-DVec3::X, DVec3::X]) {
        assert_eq!(shot.state, State::Touching);
        assert!(
            shot.contact_force.dot(outward) > 0.1,
            "{}",
            shot.contact_force
        );
    }
}

#[test]
pub fn a_finger_set_down_where_another_has_drawn_the_surface_away_is_outside() {
    let (mut table, _) = settled(&[at(0.0234, 0.0231, 0.003), Reading::At(probe(ABOVE))]);
    let mut inside = probe(DVec3::new(0.0246, 0.0231, TOP - 0.0005));
    inside.restart = true;
    let press = at(0.0234, 0.0231, 0.003);
    table.tick_all(DT, &[press, Reading::At(inside)]);
    inside.restart = false;
    let mut shot = Snapshot::default();
    for _ in 0..5 {
        shot = shots(&table.tick_all(DT, &[press, Reading::At(inside)]))[1];
    }
    // Half a millimetre within the body at rest, but the surface has left.
    assert_eq!((shot.hold, shot.reason), (None, ""));
    for step in 0..100 {
        let deeper = at(0.0246, 0.0231, 0.0005 + 3e-5 * f64::from(step));
        shot = shots(&table.tick_all(DT, &[press, deeper]))[1];
    }
    assert!(shot.hold.is_some() && shot.contact_force.z > 0.0);
}

#[test]
fn a_finger_alone_is_not_limited_where_the_surface_is_much_firmer_along_than_into_it() {
    let (mut compliance, mut asked) = (Blocks::default(), Vectors::default());
    let mut cones = [Cone::default(); MAX_FINGERS];
    let forces = |compliance: &Blocks, asked: &Vectors, cones: &[Cone; MAX_FINGERS]| {
        let members = Members::of(&[Some(()), None, None, None, None]);
        solve_distinct(compliance, asked, cones, &members, &Vectors::default())
    };
    compliance[0][0] = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 50.0));
    asked[0] = DVec3::new(1.0, 0.0, -2.0);
    cones[0] = Cone::about(asked[0], &compliance[0][0]).unwrap();
    let found = forces(&compliance, &asked, &cones).unwrap()[0];
    assert!(
        found.distance(DVec3::new(1.0, 0.0, -0.04)) < 1e-12,
        "{found}"
    );
    compliance[0][0] *= -1.0;
    assert!(forces(&compliance, &asked, &cones).is_none());
}
