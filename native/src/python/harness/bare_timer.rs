//! `BareTimer`: the thread to compare with.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::python::servo::counters::timing_counters;
use crate::python::vectors::check_rate;
use crate::servo::paced::Paced;

/// A native thread that only sleeps and wakes: what the machine can do at best.
#[pyclass(frozen, module = "palpate_servo.harness")]
pub struct BareTimer {
    paced: Paced,
}

#[pymethods]
impl BareTimer {
    #[new]
    #[pyo3(signature = (rate_hz=1000))]
    fn new(rate_hz: u32) -> PyResult<Self> {
        check_rate(rate_hz)?;
        Ok(Self {
            paced: Paced::bare(rate_hz)?,
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
