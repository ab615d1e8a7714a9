//! `ToolSurface`: where a tool may touch a body.

use std::sync::Arc;

use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::python::body::surface::Body;
use crate::tool::points::{self, Point};

use crate::python::tool::near_field::near_field;
use crate::python::vectors::vectors;

#[pyclass(frozen, module = "palpate_servo")]
pub struct ToolSurface {
    pub inner: Arc<points::ToolSurface>,
}

#[pymethods]
impl ToolSurface {
    #[new]
    #[allow(clippy::too_many_arguments)] // Keywords in Python.
    #[pyo3(signature = (body, positions, normals, triangles, alphas, areas, near=None))]
    fn new(
        body: &Body,
        positions: PyArrayLike2<'_, f64, AllowTypeChange>,
        normals: PyArrayLike2<'_, f64, AllowTypeChange>,
        triangles: PyArrayLike1<'_, i64, AllowTypeChange>,
        alphas: PyArrayLike2<'_, f64, AllowTypeChange>,
        areas: PyArrayLike1<'_, f64, AllowTypeChange>,
        near: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let (positions, normals, alphas) = (
            vectors("positions", &positions)?,
            vectors("normals", &normals)?,
            vectors("alphas", &alphas)?,
        );
        let (triangles, areas) = (triangles.as_array(), areas.as_array());
        let count = positions.len();
        if [normals.len(), alphas.len(), triangles.len(), areas.len()] != [count; 4] {
            return Err(PyValueError::new_err(format!(
                "there are {count} positions, {} normals, {} triangles, {} alphas and {} areas; give each \
                 as many rows",
                normals.len(),
                triangles.len(),
                alphas.len(),
                areas.len()
            )));
        }
        let points = (0..count)
            .map(|i| {
                let triangle = usize::try_from(triangles[i]).ok();
                let nodes = triangle.and_then(|t| body.inner.triangles.get(t));
                let nodes = *nodes.ok_or_else(|| {
                    PyValueError::new_err(format!(
                        "contact point {i} is on triangle {}, beyond the {} of the body; they are \
                         numbered from 0",
                        triangles[i],
                        body.inner.triangles.len()
                    ))
                })?;
                Ok(Point {
                    position: positions[i],
                    normal: normals[i],
                    nodes,
                    alpha: alphas[i].to_array(),
                    area: areas[i],
                })
            })
            .collect::<PyResult<Vec<Point>>>()?;
        let near = near.map(near_field).transpose()?;
        let surface = points::ToolSurface::new(body.inner.clone(), points, near)
            .map_err(|e| PyValueError::new_err(e.to_string()))?;
        Ok(Self {
            inner: Arc::new(surface),
        })
    }
}
