//! `tool_costs`: CPU time of a tool's ticks, once as they come, and again where one took long.
//!
//! A processor that is shared (a virtual one, too) charges a thread with time that it did not have.
//! A tick computes the same from the same state, so one that took long is led there again from a
//! state kept some ticks before, until it does not, some times at most: the least of all its times is
//! the nearest to what it computes. A tick before which the state was copied finds the caches full of
//! the copy; it is marked, and gone through again from the state before that. Beside it runs a loop of
//! fixed work, the control: what is long there is the machine alone.

use std::hint::black_box;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::clock::cpu_time::thread_seconds;
use crate::engine::lone::LoneTool;
use crate::python::harness::tool_contact::ToolContact;
use crate::python::vectors::{matrices, positive, vectors};
use crate::tool::collider::Felt;
use crate::tool::shape::Pose;
use numpy::{AllowTypeChange, PyArrayLike2, PyArrayLike3};
use pyo3::exceptions::{PyRuntimeError, PyValueError};

/// Ticks between two states that are kept.
const STRETCH: usize = 200;
/// Ticks before a stretch from which it is gone through again: the first of them finds the caches full
/// of the copy.
const WARMING: usize = 20;
/// Most replays of a stretch with a long tick.
const REPLAYS: usize = 10;
/// Ticks to one round of the control.
const TICKS_A_CONTROL: usize = 4;
/// Rounds that its length is found from.
const CALIBRATIONS: usize = 50;

/// Timing of a path.
#[derive(Debug, Clone, Copy)]
struct Timing {
    young_modulus: f64,
    /// Ticks that took longer are replayed, s.
    replay_over: f64,
    /// Time that a round of the control is to take, s; none where zero.
    control: f64,
}

/// Times, s, and counts of every tick; times of the control.
#[derive(Debug, Default)]
struct Costs {
    taken: Vec<f64>,
    computing: Vec<f64>,
    control: Vec<f64>,
    /// The state was copied just before: the tick found the caches full of that.
    copied: Vec<bool>,
    felt: Vec<Felt>,
}

impl Timing {
    /// Leads a tool along poses.
    ///
    /// # Errors
    /// Forces that are no numbers, or a replay that came out different.
    fn of_path(&self, tool: &mut LoneTool, poses: &[Pose]) -> Result<Costs, String> {
        let control = Control::lasting(self.control);
        let mut costs = Costs::default();
        let replays = self.replay_over.is_finite();
        let mut kept = replays.then(|| (0, tool.clone()));
        costs.copied.resize(poses.len(), false);
        for first in (0..poses.len()).step_by(STRETCH) {
            let behind = poses.len().min(first + STRETCH);
            let keeping = behind.saturating_sub(WARMING).max(first);
            self.lead(tool, &poses[first..keeping], &control, &mut costs)?;
            let goes_on = replays && behind < poses.len();
            let next = goes_on.then(|| (keeping, tool.clone()));
            self.lead(tool, &poses[keeping..behind], &control, &mut costs)?;
            let mut taken = costs.taken[first..].to_vec();
            if let Some((start, kept)) = &kept {
                costs.copied[*start] = true;
                self.replay(kept, poses, *start, &mut taken, &costs.felt)?;
            }
            kept = next;
            costs.computing.extend(taken);
        }
        Ok(costs)
    }

    /// Goes on along poses, with rounds of the control between ticks.
    fn lead(
        &self,
        tool: &mut LoneTool,
        poses: &[Pose],
        control: &Control,
        costs: &mut Costs,
    ) -> Result<(), String> {
        let (taken, felt) = self.timed(tool, poses, |tick| {
            if tick % TICKS_A_CONTROL == 0 && self.control > 0.0 {
                costs.control.push(control.timed());
            }
        })?;
        costs.taken.extend(taken);
        costs.felt.extend(felt);
        Ok(())
    }

    /// Goes through the last ticks, of which `felt` tells to `start`, again and again from the state
    /// before them until none of `taken`, the times of those at their end, is long.
    fn replay(
        &self,
        kept: &LoneTool,
        poses: &[Pose],
        start: usize,
        taken: &mut [f64],
        felt: &[Felt],
    ) -> Result<(), String> {
        let first = felt.len() - taken.len();
        for _ in 0..REPLAYS {
            let is_long = |&seconds: &f64| seconds > self.replay_over;
            let Some(last) = taken.iter().rposition(is_long) else {
                break;
            };
            let ticks = start..first + last + 1;
            let (again, same) = self.timed(&mut kept.clone(), &poses[ticks.clone()], |_| ())?;
            if same != felt[ticks] {
                return Err("a tick from the same state came out different".into());
            }
            for (least, again) in taken.iter_mut().zip(&again[first - start..]) {
                *least = least.min(*again);
            }
        }
        Ok(())
    }

    fn timed(
        &self,
        tool: &mut LoneTool,
        poses: &[Pose],
        mut between: impl FnMut(usize),
    ) -> Result<(Vec<f64>, Vec<Felt>), String> {
        let mut taken = Vec::with_capacity(poses.len());
        let mut all_felt = Vec::with_capacity(poses.len());
        for (tick, goal) in poses.iter().enumerate() {
            let before = thread_seconds();
            let felt = tool.follow(black_box(goal), self.young_modulus);
            let after = thread_seconds();
            let felt =
                *black_box(felt).map_err(|_| format!("tick {tick} came out as no number"))?;
            taken.push(after - before);
            all_felt.push(felt);
            between(tick);
        }
        Ok((taken, all_felt))
    }
}

/// A loop of fixed work on a few numbers.
struct Control {
    steps: u64,
}

impl Control {
    fn lasting(seconds: f64) -> Self {
        let some = Self { steps: 10_000 };
        let least = (0..CALIBRATIONS)
            .map(|_| some.timed())
            .fold(f64::INFINITY, f64::min);
        Self {
            steps: (some.steps as f64 * seconds / least) as u64,
        }
    }

    fn timed(&self) -> f64 {
        let before = thread_seconds();
        let mut number = 1.0_f64;
        for _ in 0..self.steps {
            number = black_box(number * 0.999 + 1e-3);
        }
        black_box(number);
        thread_seconds() - before
    }
}

impl Costs {
    fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("taken", PyArray1::from_vec(py, self.taken))?;
        dict.set_item("computing", PyArray1::from_vec(py, self.computing))?;
        dict.set_item("control", PyArray1::from_vec(py, self.control))?;
        dict.set_item("copied", PyArray1::from_vec(py, self.copied))?;
        let felt = &self.felt;
        dict.set_item(
            "exact",
            PyArray1::from_iter(py, felt.iter().map(|felt| felt.exact)),
        )?;
        let count = |name: &str, of: fn(&Felt) -> usize| {
            let counts = felt.iter().map(|felt| of(felt) as i64);
            dict.set_item(name, PyArray1::from_iter(py, counts))
        };
        count("pressed", |felt| felt.pressed)?;
        count("linearisations", |felt| felt.linearisations)?;
        count("near", |felt| felt.effort.near)?;
        count("chosen", |felt| felt.effort.chosen)?;
        count("entered", |felt| felt.effort.entered)?;
        count("left", |felt| felt.effort.left)?;
        count("fetched", |felt| felt.effort.fetched)?;
        count("decompositions", |felt| felt.effort.decompositions)?;
        count("multiplications", |felt| felt.effort.multiplications)?;
        Ok(dict)
    }
}

/// CPU time and counts of each tick of a tool that follows poses (t, 3), (t, 3, 3).
///
/// Ticks that took longer than `replay_over`, s, are gone through again from a state kept before, ten
/// times at most; RuntimeError where one comes out different. After every fourth tick a loop of fixed
/// work takes about `control`, s. Names of the counts are those of the tick's effort.
#[pyfunction]
#[pyo3(signature = (contact, positions, rotations, young_modulus, *, replay_over=None, control=0.0))]
pub fn tool_costs<'py>(
    contact: &mut ToolContact,
    py: Python<'py>,
    positions: PyArrayLike2<'_, f64, AllowTypeChange>,
    rotations: PyArrayLike3<'_, f64, AllowTypeChange>,
    young_modulus: f64,
    replay_over: Option<f64>,
    control: f64,
) -> PyResult<Bound<'py, PyDict>> {
    contact.young_modulus = positive("young_modulus", young_modulus)?;
    let positions = vectors("positions", &positions)?;
    let rotations = matrices("rotations", &rotations)?;
    if positions.len() != rotations.len() {
        return Err(PyValueError::new_err(
            "rotations must be as many as positions",
        ));
    }
    let poses: Vec<Pose> = (positions.into_iter().zip(rotations))
        .map(|(position, rotation)| Pose { position, rotation })
        .collect();
    let timing = Timing {
        young_modulus,
        replay_over: replay_over.unwrap_or(f64::INFINITY),
        control,
    };
    let inner = &mut contact.inner;
    let costs = py.detach(|| timing.of_path(inner, &poses));
    costs.map_err(PyRuntimeError::new_err)?.into_dict(py)
}
