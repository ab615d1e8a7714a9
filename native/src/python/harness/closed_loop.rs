//! `simulate_contact`, `coupled_forces`: the servo's coupling without a servo.

use glam::DVec3;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::control::safety::Limits;
use crate::harness::closed_loop::{Trial, forces, run};
use crate::harness::plant::{Hand, Plant};
use crate::python::servo::settings::GivenCoupling;
use crate::python::vectors::{check_rate, positive, table};

/// Longest run, s: it cannot be interrupted.
const MOST_SECONDS: f64 = 600.0;

/// How a touch begins, and how long it is watched; as `Press` in `tests/passivity/contact_loop.py`.
#[derive(FromPyObject)]
pub struct How {
    start: f64,
    speed: f64,
    seconds: f64,
    max_force: f64,
    max_slew: f64,
    seed: u64,
}

/// Let a device and a hand press a body with the servo's own coupling and limits, on one axis
/// (positive into the body), without a servo. SI units.
///
/// `plant`, `hand` and `how` are any objects with the attributes of [`Plant`], [`Hand`] and [`How`].
/// The result names the energies of [`crate::harness::closed_loop::Outcome`], with `trace` time (s),
/// position (m) and held force (N) of every tick (n, 3). ValueError for numbers without sense.
#[pyfunction]
#[pyo3(signature = (plant, hand, how, coupling, *, rate_hz, body_stiffness, trace=false))]
#[allow(clippy::too_many_arguments)] // Keywords in Python.
pub fn simulate_contact<'py>(
    py: Python<'py>,
    plant: Plant,
    hand: Hand,
    how: How,
    coupling: GivenCoupling,
    rate_hz: u32,
    body_stiffness: f64,
    trace: bool,
) -> PyResult<Bound<'py, PyDict>> {
    check_rate(rate_hz)?;
    positive("mass", plant.mass)?;
    for (name, value) in [
        ("damping", plant.damping),
        ("coulomb", plant.coulomb),
        ("encoder_step", plant.encoder_step),
        ("force_step", plant.force_step),
        ("delay", plant.delay),
        ("jitter", plant.jitter),
        ("hand_stiffness", hand.stiffness),
        ("hand_damping", hand.damping),
    ] {
        if !(0.0..f64::MAX).contains(&value) {
            return Err(PyValueError::new_err(format!(
                "{name} is {value}; it must be finite and at least 0"
            )));
        }
    }
    if ![hand.push, hand.target, how.start, how.speed]
        .iter()
        .all(|value| value.is_finite())
    {
        return Err(PyValueError::new_err(
            "push and target of the hand, start and speed must be finite",
        ));
    }
    if !(plant.delay + plant.jitter <= 1.0 && how.seconds <= MOST_SECONDS) {
        return Err(PyValueError::new_err(format!(
            "delay and jitter must be at most 1 s, seconds at most {MOST_SECONDS}"
        )));
    }
    let trial = Trial {
        rate_hz,
        body_stiffness: positive("body_stiffness", body_stiffness)?,
        coupling: coupling.checked()?,
        limits: Limits {
            max_force: positive("max_force", how.max_force)?,
            max_slew: positive("max_slew", how.max_slew)?,
            ramp_seconds: 0.0,
        },
        start: how.start,
        speed: how.speed,
        seconds: positive("seconds", how.seconds)?,
        seed: how.seed,
    };
    let mut ticks = Vec::new();
    let outcome = py.detach(|| {
        run(&plant, &hand, &trial, |time, position, force| {
            if trace {
                ticks.push(DVec3::new(time, position, force));
            }
        })
    });
    let result = [
        ("start", outcome.start),
        ("kinetic", outcome.kinetic),
        ("motor", outcome.motor),
        ("hand", outcome.hand),
        ("viscous", outcome.viscous),
        ("coulomb", outcome.coulomb),
        ("extracted", outcome.extracted),
        ("made_before", outcome.made_before),
        ("made_late", outcome.made_late),
        ("swing_before", outcome.swing_before),
        ("swing_late", outcome.swing_late),
        ("position", outcome.position),
        ("largest_force", outcome.largest_force),
    ]
    .into_py_dict(py)?;
    if trace {
        result.set_item("trace", table(py, ticks.into_iter())?)?;
    }
    Ok(result)
}

/// Forces (n,), N, that the servo's coupling gives for displacements (n,), m into the body, of
/// successive ticks on a body of one stiffness (N/m); negative is out of the body.
#[pyfunction]
#[pyo3(signature = (displacements, coupling, *, rate_hz, body_stiffness))]
pub fn coupled_forces<'py>(
    py: Python<'py>,
    displacements: PyReadonlyArray1<'_, f64>,
    coupling: GivenCoupling,
    rate_hz: u32,
    body_stiffness: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    check_rate(rate_hz)?;
    let found = forces(
        displacements.as_slice()?,
        positive("body_stiffness", body_stiffness)?,
        &coupling.checked()?,
        1.0 / f64::from(rate_hz),
    );
    Ok(PyArray1::from_vec(py, found))
}
