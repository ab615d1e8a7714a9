//! What a servo is set to, from the names and numbers that Python gives.

use glam::DMat3;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::body::softening::Felt;
use crate::contact::touch::ContactMode;
use crate::control::coupling::Coupling;
use crate::control::safety::Limits;
use crate::device::DeviceFrame;
use crate::proxy::Feel;
use crate::python::vectors::{
    Rows, Triple, check_rate, check_seconds, finite, is_orthonormal, matrix, positive,
};
use crate::servo::Options;

/// What stays as it is while a servo runs.
pub fn options(
    rate_hz: u32,
    max_force: f64,
    max_slew: f64,
    ramp_seconds: f64,
    max_speed: f64,
) -> PyResult<Options> {
    check_rate(rate_hz)?;
    check_seconds("ramp_seconds", ramp_seconds)?;
    Ok(Options {
        rate_hz,
        limits: Limits {
            max_force: positive("max_force", max_force)?,
            max_slew: positive("max_slew", max_slew)?,
            ramp_seconds,
        },
        max_speed: positive("max_speed", max_speed)?,
    })
}

pub fn contact_mode(name: &str) -> PyResult<ContactMode> {
    let found = ContactMode::ALL
        .into_iter()
        .find(|mode| mode.name() == name);
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "mode is {name:?}; it must be \"paper\" or \"consistent\""
        ))
    })
}

pub fn felt_choice(name: &str) -> PyResult<Felt> {
    let found = Felt::ALL.into_iter().find(|felt| felt.name() == name);
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "felt is {name:?}; it must be \"linear\" or \"corrected\""
        ))
    })
}

/// The surface, felt in the default mode.
pub fn feel(shading: bool, static_friction: f64, dynamic_friction: f64) -> PyResult<Feel> {
    let are_coefficients = static_friction.is_finite() && dynamic_friction >= 0.0;
    if !are_coefficients || dynamic_friction > static_friction {
        return Err(PyValueError::new_err(
            "friction must be 0 <= dynamic_friction <= static_friction",
        ));
    }
    Ok(Feel {
        shading,
        static_friction,
        dynamic_friction,
        mode: ContactMode::default(),
    })
}

pub fn coupling(stiffness: f64, damping: f64, passivity_control: bool) -> PyResult<Coupling> {
    if stiffness.is_nan() || stiffness <= 0.0 {
        return Err(PyValueError::new_err(
            "stiffness must be more than 0 N/m; infinite for none",
        ));
    }
    if !damping.is_finite() || damping < 0.0 {
        return Err(PyValueError::new_err(
            "damping must be finite and at least 0 N s/m",
        ));
    }
    Ok(Coupling {
        stiffness,
        damping,
        passivity_control,
    })
}

/// May mirror: a device's axes may be left-handed.
pub fn device_frame(rotation: Rows, translation: Triple, scale: f64) -> PyResult<DeviceFrame> {
    let rotation: DMat3 = matrix(rotation);
    if !is_orthonormal(&rotation) {
        return Err(PyValueError::new_err(
            "rotation is not orthonormal; a device frame may turn and scale, not shear",
        ));
    }
    Ok(DeviceFrame {
        rotation,
        translation: finite("translation", translation)?,
        scale: positive("scale", scale)?,
        epoch: 0,
    })
}
