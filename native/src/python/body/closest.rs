//! The closest places of a surface to many points.

use numpy::{AllowTypeChange, PyArray1, PyArrayLike2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::body::closest;
use crate::python::body::surface::triangle_rows;
use crate::python::vectors::{Matrix, table, vectors};

#[pyfunction]
pub fn closest_points<'py>(
    py: Python<'py>,
    nodes: PyArrayLike2<'py, f64, AllowTypeChange>,
    triangles: PyArrayLike2<'py, i64, AllowTypeChange>,
    points: PyArrayLike2<'py, f64, AllowTypeChange>,
) -> PyResult<(Bound<'py, PyArray1<i64>>, Matrix<'py>)> {
    let nodes = vectors("nodes", &nodes)?;
    let points = vectors("points", &points)?;
    let triangles = triangle_rows(&triangles)?;
    for (name, places) in [("nodes", &nodes), ("points", &points)] {
        if let Some(row) = places.iter().position(|place| !place.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "{name} has {} in row {row}; each coordinate must be finite",
                places[row]
            )));
        }
    }
    let beyond = triangles
        .iter()
        .flatten()
        .find(|&&n| n as usize >= nodes.len());
    if let Some(number) = beyond {
        return Err(PyValueError::new_err(format!(
            "a triangle names the node {number}, and there are {}; they are numbered from 0",
            nodes.len()
        )));
    }
    let found = py
        .detach(|| closest::closest_points(&nodes, &triangles, &points))
        .map_err(|problem| PyValueError::new_err(problem.to_string()))?;
    let triangle = found.iter().map(|one| i64::from(one.triangle));
    let alpha = found.iter().map(|one| one.alpha.into());
    Ok((PyArray1::from_iter(py, triangle), table(py, alpha)?))
}
