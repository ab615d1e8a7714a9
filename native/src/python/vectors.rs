//! Vectors and matrices between Python and the crate, and checks of single numbers.

use std::fmt::Display;
use std::ops::RangeInclusive;

use glam::{DMat3, DVec3};
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike2, PyArrayLike3, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::tool::shape::Pose;

pub type Triple = [f64; 3];
pub type Rows = [[f64; 3]; 3];
pub const IDENTITY: Rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub type Vector<'py> = Bound<'py, PyArray1<f64>>;
pub type Matrix<'py> = Bound<'py, PyArray2<f64>>;

pub fn finite(name: &str, v: Triple) -> PyResult<DVec3> {
    let v = DVec3::from_array(v);
    if v.is_finite() {
        Ok(v)
    } else {
        Err(PyValueError::new_err(format!(
            "{name} is {v}; each of its coordinates must be finite"
        )))
    }
}

/// Refusal of an array by its shape, beside the one that it must have.
pub fn misshaped(name: &str, shape: &[usize], wanted: impl Display) -> PyErr {
    PyValueError::new_err(format!(
        "{name} has the shape {shape:?}; it must be {wanted}"
    ))
}

pub fn positive(name: &str, value: f64) -> PyResult<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(PyValueError::new_err(format!(
            "{name} is {value}; it must be finite and greater than zero"
        )))
    }
}

pub fn array(py: Python<'_>, v: DVec3) -> Vector<'_> {
    PyArray1::from_slice(py, &v.to_array())
}

pub fn rows<'py>(py: Python<'py>, m: &[DVec3; 3]) -> PyResult<Matrix<'py>> {
    Ok(PyArray2::from_vec2(py, &m.map(|v| v.to_array().to_vec()))?)
}

/// Vectors as the rows of a matrix (k, 3).
pub fn table(py: Python<'_>, vectors: impl Iterator<Item = DVec3>) -> PyResult<Matrix<'_>> {
    let flat: Vec<f64> = vectors.flat_map(|v| v.to_array()).collect();
    let count = flat.len() / 3;
    PyArray1::from_vec(py, flat).reshape([count, 3])
}

pub fn square(py: Python<'_>, m: DMat3) -> PyResult<Matrix<'_>> {
    rows(py, &[m.row(0), m.row(1), m.row(2)])
}

pub fn matrix(rows: Rows) -> DMat3 {
    DMat3::from_cols_array_2d(&rows).transpose()
}

/// Largest entry of |R R' - 1| of a matrix that is orthonormal but for rounding.
const SKEW: f64 = 1e-6;

pub fn is_orthonormal(m: &DMat3) -> bool {
    let error = *m * m.transpose() - DMat3::IDENTITY;
    // Written so that what is no number is not orthonormal either.
    error.to_cols_array().iter().all(|e| e.abs() <= SKEW)
}

pub fn rotation(name: &str, rows: Rows) -> PyResult<DMat3> {
    let turn = matrix(rows);
    if is_orthonormal(&turn) && turn.determinant() > 0.0 {
        Ok(turn)
    } else {
        Err(PyValueError::new_err(format!(
            "{name} is {rows:?}, no rotation; give orthogonal unit columns, right-handed, without scale"
        )))
    }
}

pub fn check_rate(rate_hz: u32) -> PyResult<()> {
    if (100..=8000).contains(&rate_hz) {
        Ok(())
    } else {
        Err(PyValueError::new_err(format!(
            "rate_hz is {rate_hz}; it must be from 100 to 8000"
        )))
    }
}

/// A time that a setting may be, s.
pub fn check_seconds(name: &str, seconds: f64, range: RangeInclusive<f64>) -> PyResult<()> {
    if range.contains(&seconds) {
        Ok(())
    } else {
        Err(PyValueError::new_err(format!(
            "{name} is {seconds}; it must be from {} to {} seconds",
            range.start(),
            range.end()
        )))
    }
}

pub fn pose(position: Triple, rows: Rows) -> PyResult<Pose> {
    Ok(Pose {
        position: finite("position", position)?,
        rotation: rotation("rotation", rows)?,
    })
}

pub fn vectors(name: &str, array: &PyArrayLike2<'_, f64, AllowTypeChange>) -> PyResult<Vec<DVec3>> {
    let array = array.as_array();
    if array.ncols() != 3 {
        return Err(misshaped(name, array.shape(), "(n, 3)"));
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
        return Err(misshaped(name, array.shape(), "(n, 3, 3)"));
    }
    let block = |b: numpy::ndarray::ArrayView2<'_, f64>| {
        DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| b[[r, c]])))
    };
    Ok(array.outer_iter().map(block).collect())
}
