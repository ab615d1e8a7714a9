//! `BareTimer`: the thread to compare with.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::clock::timing::Waking;
use crate::python::servo::counters::timing_counters;
use crate::python::vectors::check_rate;
use crate::servo::paced::Paced;

/// A native thread that only sleeps and wakes, early as the servo's if asked to: what the machine can
/// do at best.
#[pyclass(frozen, module = "palpate_servo.harness")]
pub struct BareTimer {
    paced: Paced,
}

#[pymethods]
impl BareTimer {
    #[new]
    #[pyo3(signature = (rate_hz=1000, *, early_waking=false))]
    fn new(rate_hz: u32, early_waking: bool) -> PyResult<Self> {
        check_rate(rate_hz)?;
        let waking = if early_waking {
            Waking::BusyWait
        } else {
            Waking::Timer
        };
        Ok(Self {
            paced: Paced::bare(rate_hz, waking)?,
        })
    }

    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        timing_counters(py, self.paced.timing(), &self.paced.realtime())
    }

    fn stop<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        py.detach(|| self.paced.stop());
        self.counters(py)
    }
}
