//! `Tool`: its shape.

use glam::DVec3;
use numpy::{AllowTypeChange, PyArray1, PyArrayLike2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::python::vectors::{Matrix, Vector, table, vectors};
use crate::tool::shape::{self};

#[pyclass(frozen, module = "palpate_servo")]
pub struct Tool {
    pub inner: shape::Tool,
}

#[pymethods]
impl Tool {
    #[new]
    fn new(core: PyArrayLike2<'_, f64, AllowTypeChange>, radius: f64) -> PyResult<Self> {
        let core = vectors("core", &core)?;
        let refused = |e: crate::tool::shape::hull::HullError| PyValueError::new_err(e.to_string());
        let inner = shape::Tool::new(&core, radius).map_err(refused)?;
        Ok(Self { inner })
    }

    #[staticmethod]
    fn endless(reach: f64) -> PyResult<Self> {
        let refused = |e: crate::tool::shape::hull::HullError| PyValueError::new_err(e.to_string());
        let inner = shape::Tool::endless(reach).map_err(refused)?;
        Ok(Self { inner })
    }

    #[getter]
    fn stride(&self) -> f64 {
        self.inner.stride()
    }

    fn distance<'py>(
        &self,
        py: Python<'py>,
        points: PyArrayLike2<'_, f64, AllowTypeChange>,
    ) -> PyResult<(Vector<'py>, Matrix<'py>)> {
        let found: Vec<(f64, DVec3)> = (vectors("points", &points)?.into_iter())
            .map(|point| self.inner.distance(point))
            .collect();
        let distances = PyArray1::from_iter(py, found.iter().map(|&(distance, _)| distance));
        Ok((
            distances,
            table(py, found.iter().map(|&(_, normal)| normal))?,
        ))
    }
}
