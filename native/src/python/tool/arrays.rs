//! Poses, vectors and matrices of tools from numpy arrays.

use glam::{DMat3, DVec3};
use numpy::{AllowTypeChange, PyArrayLike2, PyArrayLike3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::python::vectors::{Rows, Triple, finite, rotation};
use crate::tool::shape::Pose;

pub fn pose(position: Triple, rows: Rows) -> PyResult<Pose> {
    Ok(Pose {
        position: finite("position", position)?,
        rotation: rotation("rotation", rows)?,
    })
}

pub fn vectors(name: &str, array: &PyArrayLike2<'_, f64, AllowTypeChange>) -> PyResult<Vec<DVec3>> {
    let array = array.as_array();
    if array.ncols() != 3 {
        return Err(PyValueError::new_err(format!(
            "{name} has {} columns, not three",
            array.ncols()
        )));
    }
    let rows = array.rows().into_iter();
    Ok(rows.map(|r| DVec3::new(r[0], r[1], r[2])).collect())
}

pub fn matrices(
    name: &str,
    array: &PyArrayLike3<'_, f64, AllowTypeChange>,
) -> PyResult<Vec<DMat3>> {
    let array = array.as_array();
    if array.shape()[1..] != [3, 3] {
        return Err(PyValueError::new_err(format!(
            "{name} must have the shape (n, 3, 3)"
        )));
    }
    let block = |b: numpy::ndarray::ArrayView2<'_, f64>| {
        DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| b[[r, c]])))
    };
    Ok(array.outer_iter().map(block).collect())
}
