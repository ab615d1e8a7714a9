//! `device_coupling`: the coupling for devices of which little is known.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::control::coupling::Coupling;
use crate::python::vectors::check_rate;

#[pyfunction]
#[pyo3(signature = (rate_hz=1000, *, encoder_step=0.0))]
pub fn device_coupling(
    py: Python<'_>,
    rate_hz: u32,
    encoder_step: f64,
) -> PyResult<Bound<'_, PyDict>> {
    check_rate(rate_hz)?;
    if !(encoder_step >= 0.0 && encoder_step.is_finite()) {
        return Err(PyValueError::new_err(format!(
            "encoder_step is {encoder_step}; it must be finite and at least 0 m"
        )));
    }
    let coupling = Coupling::for_encoders(rate_hz, encoder_step);
    let found = PyDict::new(py);
    found.set_item("stiffness", coupling.stiffness)?;
    found.set_item("damping", coupling.damping)?;
    found.set_item("passivity_control", coupling.passivity_control)?;
    Ok(found)
}
