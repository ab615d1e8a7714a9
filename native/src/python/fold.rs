//! `MovedSurface`: where the moved surface of a body is within the body itself.

use std::sync::Mutex;

use glam::DVec3;
use numpy::{AllowTypeChange, PyArray1, PyArrayLike2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::fold::Moved;
use crate::python::body::surface::Body;
use crate::python::vectors::{Matrix, Vector, positive, table, vectors};
use crate::servo::paced::locked;

type Numbers<'py> = Bound<'py, PyArray1<i64>>;
/// Nodes, triangles over them, area coordinates there, normals, depths.
type Told<'py> = (
    Numbers<'py>,
    Numbers<'py>,
    Matrix<'py>,
    Matrix<'py>,
    Vector<'py>,
);

#[pyclass(frozen, module = "palpate_servo")]
pub struct MovedSurface {
    inner: Mutex<Moved>,
}

#[pymethods]
impl MovedSurface {
    #[new]
    fn new(body: &Body) -> Self {
        Self {
            inner: Mutex::new(Moved::new(body.inner.clone())),
        }
    }

    fn folds<'py>(
        &self,
        py: Python<'py>,
        places: PyArrayLike2<'py, f64, AllowTypeChange>,
        deepest: f64,
    ) -> PyResult<Told<'py>> {
        let places = self.places(&places)?;
        let deepest = positive("deepest", deepest)?;
        let found = py.detach(|| locked(&self.inner).folds(&places, deepest));
        Ok((
            PyArray1::from_iter(py, found.iter().map(|fold| i64::from(fold.node))),
            PyArray1::from_iter(py, found.iter().map(|fold| i64::from(fold.triangle))),
            table(py, found.iter().map(|fold| fold.alpha.into()))?,
            table(py, found.iter().map(|fold| fold.normal))?,
            PyArray1::from_iter(py, found.iter().map(|fold| fold.depth)),
        ))
    }

    /// Rows of the rotations of all nodes, (3 n, 3).
    fn turns<'py>(
        &self,
        py: Python<'py>,
        places: PyArrayLike2<'py, f64, AllowTypeChange>,
    ) -> PyResult<Matrix<'py>> {
        let places = self.places(&places)?;
        let found = py.detach(|| locked(&self.inner).turns(&places));
        let rows = found
            .iter()
            .flat_map(|turn| [0, 1, 2].map(|row| turn.row(row)));
        table(py, rows)
    }
}

impl MovedSurface {
    fn places(&self, given: &PyArrayLike2<'_, f64, AllowTypeChange>) -> PyResult<Vec<DVec3>> {
        let places = vectors("places", given)?;
        let count = locked(&self.inner).node_count();
        if places.len() != count || !places.iter().all(|place| place.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "places has {} rows; {count} are needed, all of finite numbers",
                places.len()
            )));
        }
        Ok(places)
    }
}
