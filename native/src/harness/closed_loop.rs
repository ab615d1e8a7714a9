//! A device, a hand and a stiff place in a loop with the servo's own coupling and safety: shows
//! where a contact stays passive. Used by benchmarks and tests, never by the servo.

use std::collections::VecDeque;

use glam::{DMat3, DVec3};

use crate::control::coupling::{Contact, Coupler, Coupling, series_compliance};
use crate::control::safety::{Limits, Safety};
use crate::harness::plant::{Hand, Motion, Plant};

/// A run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Ticks a second.
    pub rate_hz: u32,
    /// Stiffness of the body, N/m.
    pub body_stiffness: f64,
    /// Coupling between body and device.
    pub coupling: Coupling,
    /// The servo's.
    pub limits: Limits,
    /// Position at the start, m into the body.
    pub start: f64,
    /// Speed at the start, m/s.
    pub speed: f64,
    /// s.
    pub seconds: f64,
    /// Seed of the jitter.
    pub seed: u64,
}

/// Energies, J: start + motor + hand = kinetic + viscous + coulomb.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Outcome {
    /// Kinetic energy at the start.
    pub start: f64,
    /// Kinetic energy at the end.
    pub kinetic: f64,
    /// Work of the motor.
    pub motor: f64,
    /// Work of the hand on the device.
    pub hand: f64,
    /// Taken by viscous friction.
    pub viscous: f64,
    /// Taken by Coulomb friction.
    pub coulomb: f64,
    /// The most that the motor had given at any time beyond what friction had taken: what a hand
    /// could have got out. Never more than 0 for a passive device that begins outside the body.
    pub extracted: f64,
    /// Made by the loop in the third quarter: work of the motor beyond that of the ideal spring.
    pub made_before: f64,
    /// The same in the last quarter.
    pub made_late: f64,
    /// Highest minus lowest position in the last quarter, m.
    pub swing_late: f64,
    /// The same in the third quarter, m.
    pub swing_before: f64,
    /// Position at the end, m.
    pub position: f64,
    /// Largest force held, N.
    pub largest_force: f64,
}

/// Longest step of the motion, s.
const STEP_SECONDS: f64 = 62.5e-6;

/// Runs a trial; `trace` is told time, position (m) and held force (N) at every tick.
///
/// With `coulomb` friction the hand's push and the motor must overcome it before anything moves.
pub fn run(
    plant: &Plant,
    hand: &Hand,
    trial: &Trial,
    mut trace: impl FnMut(f64, f64, f64),
) -> Outcome {
    let period = 1.0 / f64::from(trial.rate_hz);
    let rate = (plant.damping + hand.damping) / plant.mass + (hand.stiffness / plant.mass).sqrt();
    let steps = (period / STEP_SECONDS)
        .ceil()
        .max((period * rate / 0.25).ceil())
        .max(1.0) as u64;
    let step = period / steps as f64;
    let mut dice = trial.seed;
    let mut body = Motion::new(plant, hand, (trial.start, trial.speed));
    let mut controller = Controller::new(trial, plant.force_step);
    let mut on_the_way: VecDeque<(u64, f64)> = VecDeque::new();
    // Before the start all had been at rest there.
    let mut held = -seen_stiffness(trial) * trial.start.max(0.0);
    let mut outcome = Outcome {
        start: 0.5 * plant.mass * trial.speed * trial.speed,
        ..Outcome::default()
    };
    let seen = seen_stiffness(trial);
    let stored = |x: f64| stored_energy(seen, trial.limits.max_force, plant, x);
    let ticks = (trial.seconds / period).round() as u64;
    let late = ticks - ticks / 4;
    let mut given = [0.0; 2];
    let mut swings = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for tick in 0..ticks {
        let command = controller.force(rounded(body.x, plant.encoder_step), period);
        let wait = plant.delay + plant.jitter * unit(&mut dice);
        let due = tick * steps + (wait / step).round() as u64;
        while on_the_way.back().is_some_and(|&(other, _)| other >= due) {
            on_the_way.pop_back();
        }
        on_the_way.push_back((due, command));
        if tick == ticks / 2 {
            given[0] = body.motor + stored(body.x);
        }
        if tick == late {
            given[1] = body.motor + stored(body.x);
        }
        for inner in tick * steps..(tick + 1) * steps {
            while on_the_way.front().is_some_and(|&(due, _)| due <= inner) {
                held = on_the_way.pop_front().map_or(held, |(_, force)| force);
            }
            body.advance(held, step);
            outcome.extracted = outcome
                .extracted
                .max(body.motor - body.viscous - body.rubbed);
            if tick >= ticks / 2 {
                let (low, high) = &mut swings[usize::from(tick >= late)];
                (*low, *high) = (low.min(body.x), high.max(body.x));
            }
        }
        outcome.largest_force = outcome.largest_force.max(held.abs());
        trace((tick + 1) as f64 * period, body.x, held);
    }
    outcome.kinetic = 0.5 * plant.mass * body.v * body.v;
    outcome.made_before = given[1] - given[0];
    outcome.made_late = body.motor + stored(body.x) - given[1];
    [outcome.swing_before, outcome.swing_late] =
        swings.map(|(low, high)| if high > low { high - low } else { 0.0 });
    (outcome.motor, outcome.hand) = (body.motor, body.hand);
    (outcome.viscous, outcome.coulomb) = (body.viscous, body.rubbed);
    outcome.position = body.x;
    outcome
}

/// Forces (N) of the coupling for the displacements (m, positive into the body) of successive ticks.
pub fn forces(
    displacements: &[f64],
    body_stiffness: f64,
    coupling: &Coupling,
    dt: f64,
) -> Vec<f64> {
    let mut coupler = Coupler::default();
    displacements
        .iter()
        .map(|&u| {
            let force = coupled(&mut coupler, u, body_stiffness, coupling, dt);
            coupler.sent(DVec3::X * force);
            force
        })
        .collect()
}

fn coupled(coupler: &mut Coupler, u: f64, stiffness: f64, coupling: &Coupling, dt: f64) -> f64 {
    if u <= 0.0 {
        coupler.release();
        return 0.0;
    }
    let contact = Contact {
        stiffness: DMat3::from_diagonal(DVec3::splat(stiffness)),
        displacement: DVec3::X * u,
        force: DVec3::X * (-stiffness * u),
    };
    coupler.couple(&contact, coupling, 1.0, dt).force.x
}

/// Energy (J) of an ideal spring, cut off at a largest force, pressed by `x` metres.
///
/// Seen and answered in the plant's steps it is another spring, but one that gives back all it took.
fn stored_energy(stiffness: f64, most: f64, plant: &Plant, x: f64) -> f64 {
    let (x, step) = (x.max(0.0), plant.encoder_step);
    let (counts, full) = ((x / step).round(), most / stiffness);
    if step > 0.0 {
        let force = |n: u64| rounded((stiffness * step * n as f64).min(most), plant.force_step);
        let whole: f64 = (1..counts as u64).map(force).sum();
        whole * step + force(counts as u64) * (x - (counts - 0.5) * step)
    } else if x <= full {
        0.5 * stiffness * x * x
    } else {
        most * (x - 0.5 * full)
    }
}

/// Stiffness that the device sees at rest, N/m.
fn seen_stiffness(trial: &Trial) -> f64 {
    let own = DMat3::from_diagonal(DVec3::splat(trial.body_stiffness));
    let compliance = series_compliance(&own, trial.coupling.stiffness);
    trial.body_stiffness / (1.0 + compliance * trial.body_stiffness)
}

struct Controller<'a> {
    trial: &'a Trial,
    force_step: f64,
    coupler: Coupler,
    safety: Safety,
}

impl<'a> Controller<'a> {
    fn new(trial: &'a Trial, force_step: f64) -> Self {
        Self {
            trial,
            force_step,
            coupler: Coupler::default(),
            safety: Safety::default(),
        }
    }

    /// The servo's force at a measured position.
    fn force(&mut self, position: f64, dt: f64) -> f64 {
        let trial = self.trial;
        let wanted = coupled(
            &mut self.coupler,
            position,
            trial.body_stiffness,
            &trial.coupling,
            dt,
        );
        let sent = self
            .safety
            .limit(DVec3::X * wanted, DVec3::ZERO, &trial.limits, dt)
            .map(|limited| limited.force)
            .unwrap_or_default();
        self.coupler.sent(sent);
        rounded(sent.x, self.force_step)
    }
}

fn rounded(value: f64, step: f64) -> f64 {
    if step > 0.0 {
        (value / step).round() * step
    } else {
        value
    }
}

/// SplitMix64 in [0, 1).
fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}
