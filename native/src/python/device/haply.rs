//! Models and angles of a 2DIY, from what Python gives.

use std::ops::RangeInclusive;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::device::haply::device::Calibration;
use crate::device::haply::model::{MODELS, Model};

/// Boards with USB of their own take this speed for the wish to be programmed, and forget all.
const PROGRAMMING_BAUD: u32 = 1200;

fn known_model(key: &str) -> PyResult<&'static Model> {
    Model::find(key).ok_or_else(|| {
        let known: Vec<_> = MODELS.iter().map(|model| model.key).collect();
        PyValueError::new_err(format!(
            "model {key:?} is not known; take one of {}",
            known.join(", ")
        ))
    })
}

#[pyfunction]
pub fn haply_encoder_step(model: &str) -> PyResult<f64> {
    known_model(model).map(Model::encoder_step)
}

/// Angles of an arm, degrees.
const TURN: RangeInclusive<f32> = -360.0..=360.0;

/// Model and calibration for what the user said; angles given (degrees) are always set.
pub fn haply_setup(
    model: &str,
    angles: Option<[f32; 2]>,
    recalibrate: bool,
    baud: Option<u32>,
) -> PyResult<(&'static Model, Calibration)> {
    let model = known_model(model)?;
    if let Some(angle) = angles
        .into_iter()
        .flatten()
        .find(|angle| !TURN.contains(angle))
    {
        return Err(PyValueError::new_err(format!(
            "angles has {angle}; each must be from -360 to 360 degrees"
        )));
    }
    if baud == Some(PROGRAMMING_BAUD) {
        return Err(PyValueError::new_err(
            "baud 1200 makes a hAPI board wait for new firmware; leave it at 115200",
        ));
    }
    Ok((
        model,
        Calibration {
            degrees: angles.unwrap_or_else(|| model.rest_degrees()),
            always: recalibrate || angles.is_some(),
        },
    ))
}
