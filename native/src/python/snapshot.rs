//! `Snapshot`: one tick, whole; and the recorded ticks as a structured array.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyList};

use super::vectors::{Matrix, Vector, array, rows};
use crate::device::Fault;
use crate::snapshot::Sample;

#[pyclass(frozen, module = "palpate_servo")]
pub struct Snapshot {
    pub inner: crate::snapshot::Snapshot,
}

#[pymethods]
impl Snapshot {
    #[getter]
    fn tick(&self) -> u64 {
        self.inner.tick
    }
    #[getter]
    fn time(&self) -> f64 {
        self.inner.time
    }
    #[getter]
    fn probe<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.inner.probe)
    }
    #[getter]
    fn proxy<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.inner.proxy)
    }
    #[getter]
    fn triangle<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let nodes = match self.inner.hold {
            Some(_) => self.inner.triangle.map(i64::from),
            None => [-1; 3],
        };
        PyArray1::from_slice(py, &nodes)
    }
    #[getter]
    fn triangle_index(&self) -> i64 {
        self.inner.hold.map_or(-1, |(t, _)| i64::from(t))
    }
    #[getter]
    fn alpha<'py>(&self, py: Python<'py>) -> Vector<'py> {
        PyArray1::from_slice(py, &self.inner.hold.map_or([0.0; 3], |(_, a)| a))
    }
    #[getter]
    fn nodal_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        rows(py, &self.inner.nodal_forces)
    }
    #[getter]
    fn contact_force<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.inner.contact_force)
    }
    #[getter]
    fn output_force<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.inner.output_force)
    }
    #[getter]
    fn surface_point<'py>(&self, py: Python<'py>) -> Option<Vector<'py>> {
        self.inner.surface_point.map(|point| array(py, point))
    }
    #[getter]
    fn touching(&self) -> bool {
        self.inner.hold.is_some()
    }
    #[getter]
    fn sticking(&self) -> bool {
        self.inner.sticking
    }
    #[getter]
    fn state(&self) -> &'static str {
        self.inner.state.name()
    }
    #[getter]
    fn fault(&self) -> &'static str {
        self.inner.fault.map_or("", Fault::name)
    }
    #[getter]
    fn reason(&self) -> &'static str {
        self.inner.reason
    }
    #[getter]
    fn limited(&self) -> &'static str {
        self.inner.limited
    }
    #[getter]
    fn body(&self) -> u32 {
        self.inner.body
    }
    #[getter]
    fn buttons(&self) -> u8 {
        self.inner.buttons
    }
    fn __repr__(&self) -> String {
        let s = &self.inner;
        format!(
            "Snapshot(tick={}, state={:?}, fault={:?}, probe={}, proxy={}, contact_force={})",
            s.tick,
            s.state.name(),
            self.fault(),
            s.probe,
            s.proxy,
            s.contact_force
        )
    }
}

fn bytes_of(samples: &[Sample]) -> &[u8] {
    let length = std::mem::size_of_val(samples);
    // SAFETY: `Sample` is `repr(C)` of 8-byte numbers, without padding.
    unsafe { std::slice::from_raw_parts(samples.as_ptr().cast::<u8>(), length) }
}

/// Samples as a structured numpy array of their own.
pub fn structured<'py>(py: Python<'py>, samples: &[Sample]) -> PyResult<Bound<'py, PyAny>> {
    structured_pieces(py, std::slice::from_ref(&samples))
}

/// Samples in pieces as one structured numpy array.
pub fn structured_pieces<'py>(
    py: Python<'py>,
    pieces: &[impl AsRef<[Sample]>],
) -> PyResult<Bound<'py, PyAny>> {
    let pieces = || pieces.iter().map(|piece| bytes_of(piece.as_ref()));
    let length = pieces().map(<[u8]>::len).sum();
    let bytes = PyByteArray::new_with(py, length, |mut bytes| {
        for piece in pieces() {
            let (head, rest) = bytes.split_at_mut(piece.len());
            head.copy_from_slice(piece);
            bytes = rest;
        }
        Ok(())
    })?;
    let numpy = py.import("numpy")?;
    let dtype = numpy.call_method1("dtype", (sample_fields(py)?,))?;
    numpy.call_method1("frombuffer", (bytes, dtype))
}

fn sample_fields<'py>(py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
    const _: () = assert!(size_of::<Sample>() == 18 * 8);
    let number = |name: &str, kind: &str| (name, kind).into_pyobject(py).map(Bound::into_any);
    let vector = |name: &str| (name, "=f8", (3,)).into_pyobject(py).map(Bound::into_any);
    PyList::new(
        py,
        [
            number("tick", "=u8")?,
            number("time", "=f8")?,
            vector("probe")?,
            vector("proxy")?,
            vector("surface")?,
            vector("force")?,
            vector("output")?,
            number("state", "=u8")?,
        ],
    )
}
