//! Tools on the fingers of a servo: exchanged while it runs, beside points and each other.

use std::sync::Arc;

use crate::counting::counted;
use crate::scripted::{DT, OPTIONS, Table, probe};
use glam::DVec3;
use palpate_servo::body::surface::Body;
use palpate_servo::device::reason;
use palpate_servo::device::{Fault, Reading};
use palpate_servo::servo::exchange::rings::rings;
use palpate_servo::servo::snapshot::{Snapshot, State};
use palpate_servo::servo::tip::Tip;
use palpate_servo::tool::collider::Collider;
use palpate_servo::tool::points::{Point, ToolSurface};
use palpate_servo::tool::shape::Tool;

const RADIUS: f64 = 0.012;
const TOP: f64 = 0.05;

/// A contact point on every node of the body.
pub fn surface(body: &Arc<Body>) -> Arc<ToolSurface> {
    let point = |node: usize| {
        let holds = |triangle: &&[u32; 3]| triangle.contains(&(node as u32));
        let nodes = *body.triangles.iter().find(holds).expect("on the surface");
        Point {
            position: body.nodes[node],
            normal: body.node_normal(node as u32).normalize(),
            nodes,
            alpha: nodes.map(|n| f64::from(u8::from(n as usize == node))),
            area: 1.5e-4,
        }
    };
    let points = (0..body.nodes.len()).map(point).collect();
    let surface = ToolSurface::new(body.clone(), points, None);
    Arc::new(surface.expect("sound"))
}

pub fn ball(surface: &Arc<ToolSurface>) -> Tip {
    let ball = Tool::new(&[DVec3::ZERO], RADIUS).expect("sound");
    Tip::Tool(Box::new(Collider::new(surface.clone(), ball)))
}

/// Fingers on an elastic cube, some of them with a ball.
fn table(with_ball: &[bool]) -> (Table, Arc<ToolSurface>) {
    let mut table = Table::with_fingers(crate::bodies::elastic_cube(), OPTIONS, with_ball.len());
    let surface = surface(&table.body);
    for (finger, &with_ball) in table.servo.fingers.iter_mut().zip(with_ball) {
        if with_ball {
            finger.tips.held = ball(&surface);
        }
    }
    (table, surface)
}

/// Where a ball is that far in from above.
fn in_by(x: f64, y: f64, depth: f64) -> Reading {
    Reading::At(probe(DVec3::new(x, y, TOP + RADIUS - depth)))
}

fn point_in_by(x: f64, y: f64, depth: f64) -> Reading {
    Reading::At(probe(DVec3::new(x, y, TOP - depth)))
}

/// All come down from above, and rest at the end.
fn pressed(table: &mut Table, end: impl Fn(f64) -> Vec<Reading>) -> Vec<Snapshot> {
    for step in 0..=600 {
        table.tick_all(DT, &end((f64::from(step) / 400.0).min(1.0)));
    }
    shots(table)
}

fn shots(table: &mut Table) -> Vec<Snapshot> {
    let published = table.published();
    published
        .fingers()
        .iter()
        .map(|told| told.snapshot)
        .collect()
}

fn down(way: f64, depth: f64) -> f64 {
    depth * way - 0.002 * (1.0 - way)
}

#[test]
fn a_ball_pushes_back_and_leaves_without_a_force() {
    let (mut table, _) = table(&[true]);
    let shot = pressed(&mut table, |way| {
        vec![in_by(0.025, 0.025, down(way, 0.003))]
    })[0];
    assert_eq!(
        (shot.state, shot.touching, shot.hold),
        (State::Touching, true, None)
    );
    assert!(shot.contact_force.z > 0.1, "{}", shot.contact_force);
    assert_eq!(shot.output_force, shot.contact_force);
    let shot = table.tick(in_by(0.025, 0.025, -0.001));
    assert!(!shot.touching || shot.contact_force.z < 1.0);
    let shot = pressed(&mut table, |_| vec![in_by(0.025, 0.025, -0.001)])[0];
    assert_eq!((shot.touching, shot.output_force), (false, DVec3::ZERO));
}

#[test]
fn the_friction_of_the_surface_holds_for_tools_too() {
    let (mut table, _) = table(&[true]);
    let mut rub = |sticking: f64, slipping: f64| {
        let mut settings = crate::scripted::settings();
        settings.feel.static_friction = sticking;
        settings.feel.dynamic_friction = slipping;
        table.settings.write(settings);
        for step in 0..=600 {
            let way = f64::from(step) / 300.0;
            let depth = down(way.min(1.0), 0.003);
            let aside = 0.002 * (way - 1.0).max(0.0);
            table.tick_all(DT, &[in_by(0.025 + aside, 0.025, depth)]);
        }
        let force = shots(&mut table)[0].contact_force;
        pressed(&mut table, |_| vec![in_by(0.025, 0.025, -0.002)]);
        -force.x / force.z
    };
    let (without, with, again) = (rub(0.0, 0.0), rub(0.5, 0.4), rub(0.0, 0.0));
    assert!(with > without + 0.1, "{without} {with}");
    assert_eq!(without.to_bits(), again.to_bits());
}

#[test]
fn set_down_in_the_body_it_feels_nothing_until_it_was_outside() {
    let (mut table, _) = table(&[true]);
    let shot = pressed(&mut table, |_| vec![in_by(0.025, 0.025, 0.003)])[0];
    assert_eq!((shot.touching, shot.reason), (false, reason::INSIDE));
    let shot = pressed(&mut table, |way| {
        vec![in_by(0.025, 0.025, down(way, 0.003))]
    })[0];
    assert!(shot.touching);
}

#[test]
fn a_ball_and_a_point_feel_each_other_through_the_body() {
    let both = |way: f64| {
        let depth = down(way, 0.002);
        vec![
            in_by(0.0125, 0.0125, depth),
            point_in_by(0.0382, 0.0341, depth),
        ]
    };
    let (mut two, _) = table(&[true, false]);
    let together = pressed(&mut two, both);
    let (mut ball_alone, _) = table(&[true]);
    let ball_alone = pressed(&mut ball_alone, |way| vec![both(way)[0]])[0];
    let (mut point_alone, _) = table(&[false]);
    let point_alone = pressed(&mut point_alone, |way| vec![both(way)[1]])[0];
    for (shot, alone) in together.iter().zip([ball_alone, point_alone]) {
        let (force, alone) = (shot.contact_force.length(), alone.contact_force.length());
        assert!(
            force > 0.3 * alone && force < 0.95 * alone,
            "{force} {alone}"
        );
    }
    // The point is where its finger is, with all that the ball does there.
    let surface_point = together[1].surface_point.expect("it knows");
    assert!(surface_point.distance(together[1].probe) < 1e-7);
    // Who is first makes no difference.
    let (mut turned, _) = table(&[false, true]);
    let other_way_round = pressed(&mut turned, |way| both(way).into_iter().rev().collect());
    for (shot, same) in together.iter().zip(other_way_round.iter().rev()) {
        assert!(
            shot.contact_force.distance(same.contact_force) < 1e-4 * shot.contact_force.length()
        );
    }
}

#[test]
fn two_balls_feel_each_other_and_a_fault_of_one_lifts_it_alone() {
    let both = |way: f64| {
        let depth = down(way, 0.002);
        vec![in_by(0.0125, 0.0125, depth), in_by(0.0375, 0.0375, depth)]
    };
    let (mut two, _) = table(&[true, true]);
    let together = pressed(&mut two, both);
    let (mut one, _) = table(&[true]);
    let alone = pressed(&mut one, |way| vec![both(way)[0]])[0];
    assert!(together[0].contact_force.length() < 0.95 * alone.contact_force.length());
    two.tick_all(DT, &[both(1.0)[0], Reading::Fault(Fault::Unplugged)]);
    let shot = shots(&mut two);
    assert_eq!(
        (shot[1].fault, shot[1].touching),
        (Some(Fault::Unplugged), false)
    );
    assert_eq!((shot[0].state, shot[0].fault), (State::Touching, None));
    for _ in 0..20 {
        two.tick_all(DT, &[both(1.0)[0], Reading::Fault(Fault::Unplugged)]);
    }
    let difference = shots(&mut two)[0]
        .contact_force
        .distance(alone.contact_force);
    assert!(
        difference < 1e-6 * alone.contact_force.length(),
        "{difference}"
    );
}

#[test]
fn a_tool_is_exchanged_without_allocating_or_freeing_in_the_tick() {
    let (mut table, surface) = table(&[false]);
    let mut now = 0.0;
    for round in 0..20 {
        let tip = if round % 3 == 2 {
            Tip::Point
        } else {
            ball(&surface)
        };
        assert!(table.tips[0].give(tip).is_ok());
        for tick in 0..50 {
            let height = 0.002 * f64::from(25 - tick) / 25.0;
            *table.devices[0].reading.lock().unwrap() = in_by(0.025, 0.025, -height);
            // What the scripted device keeps is the test's own.
            table.devices[0].sent.lock().unwrap().reserve(10);
            now += DT;
            let servo = &mut table.servo;
            assert_eq!(
                counted(|| servo.tick(now)).1,
                0,
                "round {round}, tick {tick}"
            );
        }
        assert_eq!(table.servo.fingers[0].has_tool(), round % 3 != 2);
        assert_eq!(table.tips[0].free_old(), 1);
    }
}

#[test]
fn on_another_body_a_tool_waits_to_be_set_again() {
    let (mut table, _) = table(&[true]);
    pressed(&mut table, |way| {
        vec![in_by(0.025, 0.025, down(way, 0.002))]
    });
    let other = crate::bodies::elastic_cube();
    table.hand.give(other.clone());
    table.hand.settle();
    for _ in 0..5 {
        let shot = table.tick(in_by(0.025, 0.025, 0.002));
        assert_eq!(
            (shot.state, shot.reason),
            (State::Waiting, reason::OTHER_BODY)
        );
        assert_eq!((shot.output_force, shot.touching), (DVec3::ZERO, false));
    }
    assert!(table.tips[0].give(ball(&surface(&other))).is_ok());
    let shot = pressed(&mut table, |way| {
        vec![in_by(0.025, 0.025, down(way, 0.002))]
    })[0];
    assert_eq!((shot.state, shot.touching), (State::Touching, true));
}

#[test]
fn a_body_does_not_take_more_tips_than_it_can_keep() {
    let (mut hand, mut holder) = rings(Tip::Point);
    let given = (0..10).filter(|_| hand.give(Tip::Point).is_ok()).count();
    assert!(given < 10);
    assert!(holder.exchange());
    assert!(!holder.exchange());
    assert_eq!(hand.free_old(), given);
}
