//! Several bodies in one tick: each as if it were alone, and tools that touch more than one.

use std::sync::Arc;

use glam::DVec3;
use palpate_servo::body::surface::Body;
use palpate_servo::contact::cones::MAX_FINGERS;
use palpate_servo::contact::ground::{Ground, MOST_BODIES, MOST_TOOLS};
use palpate_servo::engine::Engine;
use palpate_servo::engine::joint::Led;
use palpate_servo::fingers::press::{Answer, Press};
use palpate_servo::proxy::SurfacePoint;
use palpate_servo::tool::coefficients::Friction;
use palpate_servo::tool::collider::{Collider, Felt, Surfaces};
use palpate_servo::tool::points::ToolSurface;
use palpate_servo::tool::shape::Pose;

use crate::counting::counted;
use crate::on_cube::{TOP, at, rubber_cube, rubber_cube_at, sphere, surface};

const MODULI: [f64; 2] = [1e4, 2.5e4];
const RADIUS: f64 = 0.01;
const NO_SURFACE: Surfaces = [const { None }; MOST_BODIES];

fn ball(surfaces: Surfaces, friction: f64) -> Collider {
    let mut ball = Collider::on(surfaces, sphere(RADIUS));
    ball.set_friction(Friction::of(friction));
    ball
}

fn on(body: usize, points: &Arc<ToolSurface>) -> Surfaces {
    let mut surfaces = NO_SURFACE;
    surfaces[body] = Some(points.clone());
    surfaces
}

fn grounds<'a>(bodies: &[&'a Arc<Body>], moduli: &[f64]) -> Vec<Ground<'a>> {
    let bodies = bodies.iter().zip(moduli).enumerate();
    let ground = |(number, (body, modulus)): (usize, (&&'a Arc<Body>, &f64))| Ground {
        body,
        number: number as u32,
        young_modulus: *modulus,
        mobility: None,
        creep: Default::default(),
    };
    bodies.map(ground).collect()
}

/// One tick: what becomes of the points.
fn tick(
    engine: &mut Engine,
    grounds: &[Ground<'_>],
    tools: &mut [(&mut Collider, Pose)],
    points: &[Press],
) -> Vec<Answer> {
    let mut led = [const { None }; MOST_TOOLS];
    for (led, (collider, goal)) in led.iter_mut().zip(tools) {
        *led = Some(Led {
            collider,
            goal: *goal,
            presence: 1.0,
        });
    }
    let mut presses = [None; MAX_FINGERS];
    for (press, point) in presses.iter_mut().rev().zip(points) {
        *press = Some(*point);
    }
    let answers = engine.tick(grounds, &presses, &mut led);
    let answers = answers.into_iter().flatten().rev();
    answers.take(points.len()).collect()
}

fn is_near(found: DVec3, expected: DVec3, share: f64) {
    let off = found.distance(expected);
    assert!(off <= share * expected.length(), "{found} {expected} {off}");
}

fn same(found: &Collider, expected: &Collider, share: f64) -> Felt {
    let [found, expected] = [found, expected].map(|tool| *tool.felt().expect("numbers"));
    is_near(found.force, expected.force, share);
    let twisted = found.torque.distance(expected.torque);
    assert!(twisted <= share * RADIUS * expected.force.length());
    let [stiffness, alone] = [found.stiffness, expected.stiffness].map(|m| m * DVec3::ONE);
    is_near(stiffness, alone, 100.0 * share);
    assert_eq!(found.pressed, expected.pressed);
    found
}

/// On the top, `hold` moved in.
fn point(body: u8) -> Press {
    let cube = rubber_cube();
    let is_top = |nodes: &[u32; 3]| nodes.iter().all(|&node| cube.nodes[node as usize].z == TOP);
    let triangle = cube.triangles.iter().position(is_top).expect("a top");
    let displacement = DVec3::new(2e-4, 0.0, -1e-3);
    Press {
        body,
        hold: SurfacePoint {
            triangle: triangle as u32,
            alpha: [0.5, 0.2, 0.3],
        },
        touches: true,
        displacement,
        push: displacement,
        cone: None,
        most_stiffness: f64::INFINITY,
        presence: 1.0,
        remembered: DVec3::ZERO,
        carried: DVec3::ZERO,
    }
}

#[test]
fn bodies_in_a_list_are_each_as_if_alone() {
    // Where a tool sticks depends on its way, and how far each tick goes in finding it on all tools.
    for (friction, share) in [(0.0, 1e-12), (0.4, 1e-6)] {
        let bodies = [rubber_cube(), rubber_cube()];
        let points = [0, 1].map(|k: usize| surface(&bodies[k], 2));
        let mut tools = [0, 1].map(|k| ball(on(k, &points[k]), friction));
        let mut alone = [0, 1].map(|k: usize| ball(on(0, &points[k]), friction));
        let (mut engine, mut engines) = (Engine::default(), [Engine::default(), Engine::default()]);
        let list = grounds(&[&bodies[0], &bodies[1]], &MODULI);
        // Down, a little aside, and then at rest: not alike.
        let goal = |k: usize, turn: usize| {
            let way = turn.min(100) as f64 * 1e-2;
            let down = (2.0 + k as f64) * 1e-3 * way - 1e-3 * (1.0 - way);
            at(
                0.022 + 1e-3 * way,
                0.024 + 2e-3 * k as f64,
                TOP + RADIUS - down,
            )
        };
        for turn in 0..200 {
            let [first, second] = &mut tools;
            let mut both = [(first, goal(0, turn)), (second, goal(1, turn))];
            let answers = tick(&mut engine, &list, &mut both, &[point(0), point(1)]);
            for (k, (engine, tool)) in engines.iter_mut().zip(&mut alone).enumerate() {
                let own = grounds(&[&bodies[k]], &MODULI[k..]);
                let own = tick(
                    engine,
                    &own,
                    &mut [(&mut *tool, goal(k, turn))],
                    &[point(0)],
                );
                if turn == 199 {
                    let felt = same(&tools[k], tool, share);
                    assert!(felt.force.z > 0.02 && felt.exact, "{felt:?}");
                    is_near(answers[k].force, own[0].force, share);
                    assert!(answers[k].by_others.length() > 1e-5);
                    is_near(answers[k].by_others, own[0].by_others, 10.0 * share);
                    assert!(tools[k].nodal_forces(1 - k).is_empty());
                    assert!(!tools[k].nodal_forces(k).is_empty());
                }
            }
        }
    }
}

#[test]
fn a_tool_between_two_bodies_feels_both() {
    // Upside down above the first.
    let gap = 2.0 * RADIUS - 0.0045;
    let over = |node: DVec3| DVec3::new(node.x, 0.05 - node.y, 2.0 * TOP + gap - node.z);
    let bodies = [rubber_cube(), rubber_cube_at(over)];
    let points = [0, 1].map(|k: usize| surface(&bodies[k], 2));
    let list = grounds(&[&bodies[0], &bodies[1]], &MODULI);
    for (friction, share) in [(0.0, 1e-9), (0.4, 1e-5)] {
        let mut squeezed = on(0, &points[0]);
        squeezed[1] = Some(points[1].clone());
        let mut squeezed = ball(squeezed, friction);
        let mut alone = [0, 1].map(|k: usize| ball(on(k, &points[k]), friction));
        let mut engines = [0; 3].map(|_| Engine::default());
        let mut ways = |turn: i32| {
            let x = -0.02 + 0.045 * f64::from(turn.min(300)) / 300.0;
            let goal = at(x, 0.024, TOP + RADIUS - 0.002);
            tick(&mut engines[0], &list, &mut [(&mut squeezed, goal)], &[]);
            for (engine, tool) in engines[1..].iter_mut().zip(&mut alone) {
                tick(engine, &list, &mut [(tool, goal)], &[]);
            }
        };
        (0..300).for_each(&mut ways);
        assert_eq!(counted(|| (300..400).for_each(&mut ways)).1, 0);
        let felt = squeezed.felt().expect("numbers");
        let [below, above] = alone.each_ref().map(|tool| *tool.felt().expect("numbers"));
        assert!(below.force.z > 0.02 && above.force.z < -0.02);
        let largest = below.force.length().max(above.force.length());
        let off = felt.force.distance(below.force + above.force);
        assert!(off <= share * largest, "{off} {largest}");
        let stiffness = (below.stiffness + above.stiffness) * DVec3::Z;
        is_near(felt.stiffness * DVec3::Z, stiffness, 100.0 * share);
        for (k, tool) in alone.iter().enumerate() {
            let [found, expected] = [&squeezed, tool].map(|tool| {
                let nodes = tool.nodal_forces(k).iter();
                nodes.map(|&(_, force)| force).sum::<DVec3>()
            });
            is_near(found, expected, share);
        }
    }
}
