//! Bodies that give way with time: closed forms of one point, and that a body never gives what it was
//! not given.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec3;
use palpate_servo::body::surface::Body;
use palpate_servo::contact::cones::MAX_FINGERS;
use palpate_servo::contact::ground::{Ground, MOST_TOOLS};
use palpate_servo::contact::touch::{ContactMode, contact_stiffness};
use palpate_servo::creep::memory::MOST_REMEMBERED;
use palpate_servo::creep::relaxation::Creep;
use palpate_servo::creep::term::Term;
use palpate_servo::engine::Engine;
use palpate_servo::fingers::press::{Press, Presses};
use palpate_servo::proxy::SurfacePoint;

const MODULUS: f64 = 1e4;
const DT: f64 = 1e-3;
const TERMS: [Term; 3] = [
    Term {
        share: 0.9,
        seconds: 0.02,
    },
    Term {
        share: 0.6,
        seconds: 0.2,
    },
    Term {
        share: 0.4,
        seconds: 2.0,
    },
];
const HOLD: SurfacePoint = SurfacePoint {
    triangle: 100,
    alpha: [0.3, 0.3, 0.4],
};

/// A body pressed tick by tick, by points that stay.
struct Pressed {
    body: Arc<Body>,
    creep: Creep,
    engine: Engine,
    dt: f64,
}

impl Pressed {
    fn new(terms: &[Term], dt: f64) -> Self {
        Self {
            body: crate::bodies::elastic_cube(),
            creep: Creep::of(terms).expect("a series"),
            engine: Engine::default(),
            dt,
        }
    }

    /// Forces on the body, N, and how far what others do and did moves the places, m.
    fn tick(&mut self, points: &[(SurfacePoint, Option<DVec3>)]) -> Vec<(DVec3, DVec3)> {
        let step = self.creep.step(self.dt);
        let ground = Ground {
            body: &self.body,
            number: 0,
            young_modulus: MODULUS * step.firmness(),
            mobility: None,
            creep: step,
        };
        let mut presses: Presses = [None; MAX_FINGERS];
        for (press, (hold, by)) in presses.iter_mut().zip(points) {
            let displacement = by.unwrap_or(DVec3::ZERO);
            *press = Some(Press {
                body: 0,
                hold: *hold,
                touches: by.is_some(),
                displacement,
                push: self.body.face(hold.triangle).normal * -1e-3,
                cone: None,
                most_stiffness: f64::INFINITY,
                presence: 1.0,
                remembered: DVec3::ZERO,
                carried: DVec3::ZERO,
            });
        }
        let mut led = [const { None }; MOST_TOOLS];
        let answers = self.engine.tick(&[ground], &presses, &mut led);
        let answers = answers.expect("a whole body");
        (points.iter().zip(answers))
            .map(|(_, answer)| (answer.force * ground.young_modulus, answer.by_others))
            .collect()
    }

    fn inward(&self) -> DVec3 {
        -self.body.face(HOLD.triangle).normal
    }

    /// Along the inward normal, N/m in the end.
    fn stiffness(&self) -> f64 {
        let mode = ContactMode::Consistent;
        let block = contact_stiffness(&self.body, mode, HOLD.triangle, HOLD.alpha);
        MODULUS * (block * self.inward()).dot(self.inward())
    }
}

fn relaxed(t: f64) -> f64 {
    1.0 + TERMS
        .iter()
        .map(|term| term.share * (-t / term.seconds).exp())
        .sum::<f64>()
}

#[test]
fn a_point_held_still_relaxes_as_the_series_says() {
    let mut pressed = Pressed::new(&TERMS, DT);
    let (by, stiffness) = (pressed.inward() * 2e-3, pressed.stiffness());
    for tick in 1..=8_000 {
        let (force, _) = pressed.tick(&[(HOLD, Some(by))])[0];
        let t = f64::from(tick) * DT;
        // The step took the first tick, evenly: its middle is when it came.
        let expected = stiffness * 2e-3 * relaxed(t - 0.5 * DT);
        let found = force.dot(pressed.inward());
        let allowed = if tick < 5 { 2e-2 } else { 1e-3 };
        assert!(
            (found / expected - 1.0).abs() < allowed,
            "{t}: {found} {expected}"
        );
    }
}

#[test]
fn under_an_even_force_it_creeps_to_what_it_is_in_the_end() {
    let mut pressed = Pressed::new(&TERMS, DT);
    let (inward, stiffness) = (pressed.inward(), pressed.stiffness());
    let wanted = 0.5;
    let mut depth = wanted / stiffness / relaxed(0.0);
    let first = depth;
    for _ in 0..40_000 {
        let (force, _) = pressed.tick(&[(HOLD, Some(inward * depth))])[0];
        depth += (wanted - force.dot(inward)) / stiffness / relaxed(0.0);
    }
    assert!((depth * stiffness / wanted - 1.0).abs() < 1e-3, "{depth}");
    assert!(depth > 2.8 * first);
}

#[test]
fn the_loss_tangent_is_that_of_the_series_at_every_frequency() {
    for hertz in [0.05, 0.5, 2.0, 8.0, 25.0] {
        let (mut pressed, omega) = (Pressed::new(&TERMS, DT), TAU * hertz);
        let (mut stored, mut lost) = (1.0, 0.0);
        for term in &TERMS {
            let x = omega * term.seconds;
            stored += term.share * x * x / (1.0 + x * x);
            lost += term.share * x / (1.0 + x * x);
        }
        let inward = pressed.inward();
        let cycle = (1.0 / hertz / DT) as i32;
        let settle = (10.0 / DT) as i32 / cycle * cycle + cycle;
        let (mut sine, mut cosine) = (0.0, 0.0);
        for tick in 1..=settle + cycle {
            let phase = omega * f64::from(tick) * DT;
            // Always pressed: what swings is beside it.
            let by = inward * (3e-3 + 1e-3 * phase.sin());
            let force = pressed.tick(&[(HOLD, Some(by))])[0].0.dot(inward);
            if tick > settle {
                sine += force * phase.sin();
                cosine += force * phase.cos();
            }
        }
        let found = cosine / sine;
        assert!(
            (found * stored / lost - 1.0).abs() < 0.01,
            "{hertz} Hz: {found} {}",
            lost / stored
        );
    }
}

#[test]
fn a_finger_that_comes_back_meets_its_dent_and_another_finds_it_too() {
    let mut pressed = Pressed::new(&TERMS, DT);
    let (inward, near) = (
        pressed.inward(),
        SurfacePoint {
            alpha: [0.1, 0.2, 0.7],
            ..HOLD
        },
    );
    for _ in 0..2_000 {
        pressed.tick(&[(HOLD, Some(inward * 3e-3))]);
    }
    let mut last = 3e-3;
    for tick in 1..=4_000 {
        let seen = pressed.tick(&[(HOLD, None), (near, None)]);
        let dent = seen[0].1.dot(inward);
        assert!(0.0 < dent && dent < last, "{tick}: {dent} {last}");
        assert!(seen[1].1.dot(inward) > 0.3 * dent);
        last = dent;
    }
    assert!(last < 0.5e-3);
    for _ in 0..60_000 {
        pressed.tick(&[(HOLD, None)]);
    }
    assert!(pressed.engine.memories()[0].is_empty());
}

#[test]
fn over_any_way_of_two_fingers_energy_is_only_lost() {
    let mut dice = crate::bodies::Dice::new(5);
    for round in 0..20 {
        let mut pressed = Pressed::new(&TERMS, DT);
        let other = SurfacePoint {
            triangle: dice.below(pressed.body.triangles.len()) as u32,
            ..HOLD
        };
        let holds = [HOLD, other];
        let inward = holds.map(|hold| -pressed.body.face(hold.triangle).normal);
        let (mut work, mut put_in) = (0.0, 0.0_f64);
        let mut last = [(DVec3::ZERO, DVec3::ZERO); 2];
        let (speed, phase) = ([0, 1].map(|_| 2.0 + 30.0 * dice.unit()), TAU * dice.unit());
        for tick in 0..4_000 {
            let t = f64::from(tick) * DT;
            let end = if tick < 3_900 {
                1.0
            } else {
                f64::from(4_000 - tick) / 100.0
            };
            let by = [0, 1].map(|k| {
                let swing = 1.0 + (speed[k] * t + phase * k as f64).sin();
                inward[k] * (end * swing * 1.5e-3)
            });
            let told = pressed.tick(&[(holds[0], Some(by[0])), (holds[1], Some(by[1]))]);
            for k in 0..2 {
                let way = by[k] - last[k].1;
                work += 0.5 * (told[k].0 + last[k].0).dot(way);
                last[k] = (told[k].0, by[k]);
            }
            put_in = put_in.max(work);
            assert!(
                work > -1e-9 * put_in.max(1e-6),
                "{round} {tick}: {work} of {put_in}"
            );
        }
        assert!(work > 0.1 * put_in, "{round}: {work} of {put_in}");
    }
}

#[test]
fn however_long_a_finger_slides_memory_stays_bounded() {
    let mut pressed = Pressed::new(
        &[Term {
            share: 1.0,
            seconds: 1e4,
        }],
        DT,
    );
    let count = pressed.body.triangles.len() as u32;
    let inward = |pressed: &Pressed, triangle: u32| -pressed.body.face(triangle).normal;
    let mut largest = 0.0_f64;
    for tick in 0..5_000 {
        let hold = SurfacePoint {
            triangle: tick % count,
            ..HOLD
        };
        let by = inward(&pressed, hold.triangle) * 1e-3;
        let (force, _) = pressed.tick(&[(hold, Some(by))])[0];
        largest = largest.max(force.length());
    }
    assert!(pressed.engine.memories()[0].nodes().len() <= MOST_REMEMBERED);
    assert!(largest.is_finite());
}
