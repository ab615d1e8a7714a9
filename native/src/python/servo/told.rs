//! Placements and loads as Python has them.

use glam::{DMat3, DVec3};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::python::vectors::{Matrix, Vector, array, square};
use crate::rest::placement::Placement;

/// Position and rotation.
pub type Posed<'py> = (Vector<'py>, Matrix<'py>);

pub fn posed<'py>(py: Python<'py>, placement: &Placement) -> PyResult<Posed<'py>> {
    let turn = square(py, DMat3::from_quat(placement.rotation))?;
    Ok((array(py, placement.position), turn))
}

/// Numbers of the nodes of loads.
pub fn numbers<'py>(py: Python<'py>, loads: &[(u32, DVec3)]) -> Bound<'py, PyArray1<i64>> {
    PyArray1::from_iter(py, loads.iter().map(|&(node, _)| i64::from(node)))
}
