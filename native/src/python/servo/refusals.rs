//! Refusals of a servo, with their remedies.

use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::contact::cones::MAX_FINGERS;

/// Refusal of more than one finger.
pub(super) const NOT_WHOLE: &str = "several fingers need the compliance of any two nodes, which this body has \
    not kept; make it with Body(..., whole=True)";

pub(super) fn check_finger(finger: usize) -> PyResult<()> {
    if finger < MAX_FINGERS {
        return Ok(());
    }
    Err(PyValueError::new_err(format!(
        "finger is {finger}; a servo has fingers 0 to {}",
        MAX_FINGERS - 1
    )))
}

pub(super) fn no_thread(error: std::io::Error) -> PyErr {
    PyOSError::new_err(format!(
        "the system gives the servo no thread ({error}); close other programs and start again"
    ))
}
