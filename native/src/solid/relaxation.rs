//! From a linear displacement towards equilibrium, and to it.
//!
//! The energy of body and load is minimised as a function of the *linear* displacement v that is warped
//! to u = W(v):
//!
//! ```text
//! p(v) = U(W(v)) - F . W(v)
//! ```
//!
//! In these coordinates it is nearly the quadratic function v.Kv / 2 - F.v whatever the rotations, and
//! quasi-Newton steps from K^-1 come close in very few: where steps in u have to undo each rotation's false
//! stretch, these turn what they move.

mod beside;
pub mod gauge;
mod lead;
mod prepared;

use std::sync::Arc;

use gauge::Gauge;
pub use prepared::Solid;

use super::domains::Nodal;
use super::factor;
use super::four::Matrix;
use super::history::{Field, History, add, dot, scale};
use super::load::Load;
use super::search::{bound, is_enough, shorter, step_length};
use super::warp::Room;

/// Tries of one step before its direction is given up.
const MOST_TRIES: usize = 20;

/// How a search for rest ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// What the unbalanced forces would still move, as a share of what the load does, by energy.
    pub left: f64,
    /// Steps.
    pub steps: usize,
}

/// Room to relax a body in.
#[derive(Debug, Clone)]
pub struct Relaxation {
    solid: Arc<Solid>,
    /// The place: its linear displacement, gradient and potential; warped, with the forces that hold it.
    pub linear: Field,
    /// What is drawn.
    pub warped: Field,
    slope: Field,
    potential: f64,
    forces: Field,
    gradients: Vec<Matrix>,
    history: History,
    direction: Field,
    before: Field,
    start: Field,
    spare: Field,
    none: Field,
    stiffness: factor::Room<f32>,
    room: Room,
    gauge: Option<Gauge>,
}

impl Relaxation {
    /// For a body.
    pub fn new(solid: Arc<Solid>) -> Self {
        let nodes = solid.nodes();
        let field = vec![[0.0; 3]; nodes];
        let fours = solid.strained.terms[0].domains.fours();
        Self {
            linear: field.clone(),
            warped: field.clone(),
            slope: field.clone(),
            potential: 0.0,
            forces: field.clone(),
            gradients: vec![Matrix::default(); fours],
            history: History::new(nodes),
            direction: field.clone(),
            before: field.clone(),
            start: field.clone(),
            spare: field.clone(),
            none: field,
            stiffness: solid.stiffness.room(),
            room: solid.warp.room(),
            gauge: solid.gauge.clone(),
            solid,
        }
    }

    /// The body.
    pub fn solid(&self) -> &Arc<Solid> {
        &self.solid
    }

    /// The linear displacement under forces, in single precision: a place to begin steps from.
    pub fn linear_under(&mut self, forces: &Nodal) -> Field {
        let (mut found, mut balanced) = (vec![[0.0; 3]; forces.len()], forces.to_vec());
        let (gauge, room) = (self.gauge.as_ref(), &mut self.stiffness);
        (self.solid).solve(gauge, &mut balanced, room, &mut found);
        found
    }

    /// Warps [`Self::linear`].
    pub fn warp(&mut self) {
        let (gradients, room) = (&mut self.gradients, &mut self.room);
        let warp = &self.solid.warp;
        warp.warp(
            self.solid.warped_by(),
            &self.linear,
            gradients,
            room,
            &mut self.warped,
        );
        if let Some(gauge) = &self.gauge {
            gauge.still(&mut self.warped);
            gauge.add_loose(&self.linear, &mut self.warped);
        }
    }

    /// What forces do on linear displacements, where they were last warped; they are made to balance where
    /// nothing holds the body.
    pub fn pull_back(&mut self, forces: &mut Nodal, pulled: &mut Nodal) {
        let mut loose = Field::new();
        if let Some(gauge) = &self.gauge {
            loose.resize(forces.len(), [0.0; 3]);
            gauge.add_loads(forces, &mut loose);
            gauge.balance(forces);
        }
        let by = self.solid.warped_by();
        (self.solid.warp).pull_back(by, &self.gradients, forces, &mut self.room, pulled);
        add(pulled, 1.0, &loose);
    }

    /// The shape after so many steps from the linear displacement of a load: a continuous function of
    /// both, and of nothing else. Without steps it is the warped linear displacement.
    pub fn relax(&mut self, linear: &Nodal, load: &Load<'_>, steps: usize) {
        self.linear.copy_from_slice(linear);
        let work = load.linear_work(linear);
        if steps == 0 || work == 0.0 {
            return self.warp();
        }
        self.leave_rest(linear, load, work);
        for step in 1..=steps {
            let descent = self.direct(load);
            let most = bound(work, descent);
            let (before, slope) = (self.potential, -most * descent);
            self.before.copy_from_slice(&self.linear);
            self.start.copy_from_slice(&self.warped);
            self.go(most, load);
            let share = step_length(before, slope, self.potential);
            if step == steps {
                // On the chord: warping once more would change little.
                for (end, start) in self.warped.iter_mut().zip(&self.start) {
                    for axis in 0..3 {
                        end[axis] = start[axis] + share * (end[axis] - start[axis]);
                    }
                }
                return;
            }
            if share < 1.0 {
                self.go(share * most, load);
            }
            self.learn(share * most, load);
        }
    }

    /// Steps from where it is.
    fn descend(&mut self, load: &Load<'_>, work: f64, close: f64, most: usize) -> Rest {
        let mut rest = Rest {
            left: f64::INFINITY,
            steps: 0,
        };
        loop {
            let descent = self.direct(load);
            rest.left = (descent / work).max(0.0).sqrt();
            if rest.left <= close || rest.steps == most {
                return rest;
            }
            if !self.step(bound(work, descent), descent, load) {
                if self.history.is_empty() {
                    return rest;
                }
                // Again by the stiffness at rest alone.
                self.history.clear();
            }
            rest.steps += 1;
        }
    }

    /// One step of so much of the direction at most; false where none leads downhill.
    fn step(&mut self, most: f64, descent: f64, load: &Load<'_>) -> bool {
        let before = self.potential;
        self.before.copy_from_slice(&self.linear);
        let mut share = most;
        for _ in 0..MOST_TRIES {
            self.go(share, load);
            if is_enough(before, -descent, share, self.potential) {
                self.learn(share, load);
                return true;
            }
            share = shorter(before, -descent, share, self.potential);
        }
        self.go(0.0, load);
        false
    }

    /// To the place on the way from rest: all of it, or the share where a body hardens.
    fn leave_rest(&mut self, linear: &Nodal, load: &Load<'_>, work: f64) {
        self.history.clear();
        self.arrive(load);
        let share = step_length(0.0, -work, self.potential);
        if share < 1.0 {
            scale(&mut self.linear, share);
            self.arrive(load);
        }
        // At rest the gradient is known without any work, so the way from there counts as a step.
        self.spare.fill([0.0; 3]);
        self.before.fill([0.0; 3]);
        load.take_from(&self.before, &mut self.spare);
        load.take_turning_from(&mut self.spare);
        if let Some(gauge) = &self.gauge {
            gauge.balance_held(&mut self.spare);
        }
        self.find_slope(load);
        (self.history).take(share, linear, &self.spare, &self.slope);
    }

    /// Finds the direction; what it promises, minus its slope.
    fn direct(&mut self, load: &Load<'_>) -> f64 {
        let (solid, gauge, room) = (&self.solid, self.gauge.as_ref(), &mut self.stiffness);
        let (held, back) = (&mut self.forces, &mut self.start);
        let solve = |right: &Nodal, solution: &mut Nodal| {
            held.copy_from_slice(right);
            solid.solve(gauge, held, room, solution);
            if let Some(led) = load.led {
                led.hold(solution);
            }
            if let Some(against) = load.against {
                against.held_back(solution, held);
                solid.solve(gauge, held, room, back);
                add(solution, -1.0, back);
            }
        };
        (self.history).direct(&self.slope, &mut self.spare, &mut self.direction, solve);
        -dot(&self.slope, &self.direction)
    }

    /// To a share of the direction from where the step began.
    fn go(&mut self, share: f64, load: &Load<'_>) {
        self.linear.copy_from_slice(&self.before);
        add(&mut self.linear, share, &self.direction);
        self.arrive(load);
    }

    /// Keeps a step of this share.
    fn learn(&mut self, share: f64, load: &Load<'_>) {
        self.before.copy_from_slice(&self.slope);
        self.find_slope(load);
        (self.history).take(share, &self.direction, &self.before, &self.slope);
    }

    /// Energies and forces at the linear displacement.
    fn arrive(&mut self, load: &Load<'_>) {
        self.warp();
        let energy = (self.solid.strained).energy_and_forces(&self.warped, &mut self.forces);
        self.potential = energy + load.energy(&self.linear, &self.warped);
    }

    /// The gradient where it has arrived.
    fn find_slope(&mut self, load: &Load<'_>) {
        load.take_from(&self.warped, &mut self.forces);
        let mut slope = std::mem::take(&mut self.slope);
        let mut forces = std::mem::take(&mut self.forces);
        self.pull_back(&mut forces, &mut slope);
        load.take_turning_from(&mut slope);
        if let Some(gauge) = &self.gauge {
            gauge.balance_held(&mut slope);
        }
        (self.slope, self.forces) = (slope, forces);
    }
}
