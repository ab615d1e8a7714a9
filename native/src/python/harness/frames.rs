//! `encode_frame` and `Decoder`: the codec for tests against other implementations.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::device::link::codec;

/// COBS(payload + CRC) and a zero byte; ValueError beyond 1 to 58 bytes.
#[pyfunction]
pub fn encode_frame<'py>(py: Python<'py>, payload: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
    let mut frame = [0; codec::MAX_FRAME];
    let length = codec::encode(payload, &mut frame).ok_or_else(|| {
        PyValueError::new_err(format!(
            "a payload of {} bytes does not fit a frame; 1 to {} do",
            payload.len(),
            codec::MAX_PAYLOAD
        ))
    })?;
    Ok(PyBytes::new(py, &frame[..length]))
}

/// Cuts bytes of the link into payloads.
#[pyclass(module = "palpate_servo.harness")]
pub struct Decoder {
    inner: codec::Decoder,
}

#[pymethods]
impl Decoder {
    #[new]
    fn new() -> Self {
        Self {
            inner: codec::Decoder::default(),
        }
    }

    fn feed<'py>(&mut self, py: Python<'py>, data: &[u8]) -> Vec<Bound<'py, PyBytes>> {
        data.iter()
            .filter_map(|&byte| self.inner.push(byte).map(|p| PyBytes::new(py, p)))
            .collect()
    }

    #[getter]
    fn crc_errors(&self) -> u64 {
        self.inner.errors.crc
    }

    #[getter]
    fn cobs_errors(&self) -> u64 {
        self.inner.errors.cobs
    }

    #[getter]
    fn oversize(&self) -> u64 {
        self.inner.errors.oversize
    }
}
