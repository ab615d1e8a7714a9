//! `simulate_contact`, `coupled_forces`: the servo's coupling without a servo.

use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::control::safety::Limits;
use crate::harness::closed_loop::{Trial, forces, run};
use crate::harness::plant::{Hand, Plant};
use crate::python::servo::settings::coupling;
use crate::python::vectors::{check_rate, positive};

/// Longest run, s: it cannot be interrupted.
const MOST_SECONDS: f64 = 600.0;

/// Let a device and a hand press a body with the servo's own coupling and limits, on one axis
/// (positive into the body), without a servo. SI units.
///
/// mass, damping (viscous) and coulomb friction are the device's; encoder_step (m) and force_step (N)
/// may be 0. delay (s) is all that lies between reading and obeying besides the holding of a tick,
/// jitter its random part. The hand is a spring and a damper to hand_target and a constant push. The
/// result names the energies of [`crate::harness::closed_loop::Outcome`], with `trace` time (s),
/// position (m) and held force (N) of every tick (n, 3). ValueError for numbers without sense.
#[pyfunction]
#[pyo3(signature = (*, mass, damping, coulomb, encoder_step, force_step, delay, jitter,
    hand_stiffness, hand_damping, hand_push, hand_target, rate_hz, body_stiffness, stiffness,
    coupling_damping, passivity_control, start, speed, seconds, max_force=3.0, max_slew=1000.0,
    seed=1, trace=false))]
#[allow(clippy::too_many_arguments)] // Keywords in Python.
pub fn simulate_contact<'py>(
    py: Python<'py>,
    mass: f64,
    damping: f64,
    coulomb: f64,
    encoder_step: f64,
    force_step: f64,
    delay: f64,
    jitter: f64,
    hand_stiffness: f64,
    hand_damping: f64,
    hand_push: f64,
    hand_target: f64,
    rate_hz: u32,
    body_stiffness: f64,
    stiffness: f64,
    coupling_damping: f64,
    passivity_control: bool,
    start: f64,
    speed: f64,
    seconds: f64,
    max_force: f64,
    max_slew: f64,
    seed: u64,
    trace: bool,
) -> PyResult<Bound<'py, PyDict>> {
    check_rate(rate_hz)?;
    for (name, value) in [
        ("damping", damping),
        ("coulomb", coulomb),
        ("encoder_step", encoder_step),
        ("force_step", force_step),
        ("delay", delay),
        ("jitter", jitter),
        ("hand_stiffness", hand_stiffness),
        ("hand_damping", hand_damping),
    ] {
        if !(0.0..f64::MAX).contains(&value) {
            return Err(PyValueError::new_err(format!(
                "{name} is {value}; it must be finite and at least 0"
            )));
        }
    }
    if !(hand_push.is_finite() && hand_target.is_finite() && start.is_finite() && speed.is_finite())
    {
        return Err(PyValueError::new_err(
            "hand_push, hand_target, start and speed must be finite",
        ));
    }
    if !(delay + jitter <= 1.0 && seconds <= MOST_SECONDS) {
        return Err(PyValueError::new_err(format!(
            "delay and jitter must be at most 1 s, seconds at most {MOST_SECONDS}"
        )));
    }
    let plant = Plant {
        mass: positive("mass", mass)?,
        damping,
        coulomb,
        encoder_step,
        force_step,
        delay,
        jitter,
    };
    let hand = Hand {
        stiffness: hand_stiffness,
        damping: hand_damping,
        push: hand_push,
        target: hand_target,
    };
    let trial = Trial {
        rate_hz,
        body_stiffness: positive("body_stiffness", body_stiffness)?,
        coupling: coupling(stiffness, coupling_damping, passivity_control)?,
        limits: Limits {
            max_force: positive("max_force", max_force)?,
            max_slew: positive("max_slew", max_slew)?,
            ramp_seconds: 0.0,
        },
        start,
        speed,
        seconds: positive("seconds", seconds)?,
        seed,
    };
    let mut ticks = Vec::new();
    let outcome = py.detach(|| {
        run(&plant, &hand, &trial, |time, position, force| {
            if trace {
                ticks.push([time, position, force]);
            }
        })
    });
    let result = PyDict::new(py);
    for (name, value) in [
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
    ] {
        result.set_item(name, value)?;
    }
    if trace {
        let flat: Vec<f64> = ticks.iter().flatten().copied().collect();
        result.set_item(
            "trace",
            PyArray1::from_vec(py, flat).reshape([ticks.len(), 3])?,
        )?;
    }
    Ok(result)
}

/// Forces (n,), N, that the servo's coupling gives for displacements (n,), m into the body, of
/// successive ticks on a body of one stiffness (N/m); negative is out of the body.
#[pyfunction]
#[pyo3(signature = (displacements, *, rate_hz, body_stiffness, stiffness, damping,
    passivity_control))]
pub fn coupled_forces<'py>(
    py: Python<'py>,
    displacements: PyReadonlyArray1<'_, f64>,
    rate_hz: u32,
    body_stiffness: f64,
    stiffness: f64,
    damping: f64,
    passivity_control: bool,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    check_rate(rate_hz)?;
    let found = forces(
        displacements.as_slice()?,
        positive("body_stiffness", body_stiffness)?,
        &coupling(stiffness, damping, passivity_control)?,
        1.0 / f64::from(rate_hz),
    );
    Ok(PyArray1::from_vec(py, found))
}
