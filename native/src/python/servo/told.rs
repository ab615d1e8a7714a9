//! Placements and loads as Python has them.

use glam::{DMat3, DVec3};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::python::vectors::{Matrix, Vector, array, square, table};
use crate::rest::placement::Placement;

/// Position and rotation.
pub type Posed<'py> = (Vector<'py>, Matrix<'py>);

pub fn posed<'py>(py: Python<'py>, placement: &Placement) -> PyResult<Posed<'py>> {
    let turn = square(py, DMat3::from_quat(placement.rotation))?;
    Ok((array(py, placement.position), turn))
}

/// Forces on nodes of surfaces besides those of fingers, N.
#[derive(Clone, Default)]
pub struct Loads {
    /// Under which the body would look as past forces have left it.
    pub remembered: Vec<(u32, DVec3)>,
    /// By what bears it, and by all that presses the others, in their order behind it.
    pub borne: Vec<Vec<(u32, DVec3)>>,
}

impl Loads {
    /// What bears the body that is touched.
    pub fn own(&self) -> &[(u32, DVec3)] {
        self.borne.first().map_or(&[], Vec::as_slice)
    }
}

/// Nodes of a surface, and forces on them.
pub type Load<'py> = (Bound<'py, PyArray1<i64>>, Matrix<'py>);

/// Forces of loads.
pub fn forces<'py>(py: Python<'py>, loads: &[(u32, DVec3)]) -> PyResult<Matrix<'py>> {
    table(py, loads.iter().map(|&(_, force)| force))
}

/// Numbers of the nodes of loads.
pub fn numbers<'py>(py: Python<'py>, loads: &[(u32, DVec3)]) -> Bound<'py, PyArray1<i64>> {
    PyArray1::from_iter(py, loads.iter().map(|&(node, _)| i64::from(node)))
}
