//! `seconds_per_block`: time to read a block of a compliance.

use std::hint::black_box;
use std::time::Instant;

use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::python::body::compliance::Compliance;

/// Time to read a block of a compliance, s, mean over pairs of nodes; IndexError beyond its nodes.
#[pyfunction]
pub fn seconds_per_block(compliance: &Compliance, pairs: Vec<(usize, usize)>) -> PyResult<f64> {
    let count = compliance.inner.node_count();
    if pairs.is_empty() || pairs.iter().any(|&(i, j)| i >= count || j >= count) {
        return Err(PyIndexError::new_err(format!(
            "no pairs, or some beyond the {count} nodes"
        )));
    }
    let start = Instant::now();
    for &(i, j) in &pairs {
        black_box(compliance.inner.block(i, j));
    }
    Ok(start.elapsed().as_secs_f64() / pairs.len() as f64)
}
