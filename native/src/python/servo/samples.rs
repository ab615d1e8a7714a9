//! Recorded ticks as a structured numpy array.

use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyList};

use crate::servo::snapshot::Sample;

fn bytes_of(samples: &[Sample]) -> &[u8] {
    let length = std::mem::size_of_val(samples);
    // SAFETY: `Sample` is `repr(C)` of numbers of 8 bytes and then two of 4, without padding.
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
            number("state", "=u4")?,
            number("finger", "=u4")?,
        ],
    )
}
