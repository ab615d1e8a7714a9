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

/// Longest time of which samples are kept, s: their memory is handed out at the start, for a tick must
/// not ask for any. At the highest rate 69 MB a finger.
const MOST_KEPT_SECONDS: f64 = 60.0;

pub(super) fn check_kept(seconds: f64) -> PyResult<()> {
    if (0.0..=MOST_KEPT_SECONDS).contains(&seconds) {
        return Ok(());
    }
    Err(PyValueError::new_err(format!(
        "record_seconds is {seconds}; it must be from 0 to {MOST_KEPT_SECONDS}: so long samples are kept \
         until they are read; for a longer time call start_recording"
    )))
}

pub(super) fn no_thread(error: std::io::Error) -> PyErr {
    PyOSError::new_err(format!(
        "the system gives the servo no thread ({error}); close other programs and start again"
    ))
}
