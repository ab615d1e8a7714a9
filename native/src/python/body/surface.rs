//! `Body`: arrays in, contact forces and distances out.

use std::sync::Arc;

use glam::DVec3;
use numpy::{AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLike2, PyArrayLike3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::body::closest;
use crate::body::surface;
use crate::contact::touch;
use crate::python::body::compliance::Compliance;
use crate::python::servo::settings::contact_mode;
use crate::python::vectors::{
    Matrix, Rows, Triple, Vector, array, finite, matrices, misshaped, rows, vectors,
};

#[pyclass(frozen, module = "palpate_servo")]
pub struct Body {
    pub inner: Arc<surface::Body>,
}

#[pymethods]
impl Body {
    #[new]
    #[pyo3(signature = (nodes, triangles, contact_blocks, compliance=None, free_nodes=None, *,
        whole=false))]
    fn new(
        nodes: PyArrayLike2<'_, f64, AllowTypeChange>,
        triangles: PyArrayLike2<'_, i64, AllowTypeChange>,
        contact_blocks: PyArrayLike3<'_, f64, AllowTypeChange>,
        compliance: Option<&Compliance>,
        free_nodes: Option<PyArrayLike1<'_, i64, AllowTypeChange>>,
        whole: bool,
    ) -> PyResult<Self> {
        let nodes = vectors("nodes", &nodes)?;
        let blocks = matrices("contact_blocks", &contact_blocks)?;
        let triangles = triangle_rows(&triangles)?;
        let refused = |e: surface::BodyError| PyValueError::new_err(e.to_string());
        let mut inner = surface::Body::new(nodes, triangles, blocks).map_err(refused)?;
        if let Some(compliance) = compliance {
            let free_nodes = match free_nodes {
                Some(numbers) => node_numbers("free_nodes", &numbers)?,
                None => (0..inner.nodes.len() as u32).collect(),
            };
            inner = if whole {
                inner.with_whole_compliance(compliance.inner.clone(), &free_nodes)
            } else {
                inner.with_compliance(&compliance.inner, &free_nodes)
            }
            .map_err(refused)?;
        }
        Ok(Self {
            inner: Arc::new(inner),
        })
    }

    #[getter]
    fn node_count(&self) -> usize {
        self.inner.nodes.len()
    }

    #[pyo3(signature = (triangle, alpha, displacement, young_modulus, mode="consistent"))]
    fn contact<'py>(
        &self,
        py: Python<'py>,
        triangle: usize,
        alpha: Triple,
        displacement: Triple,
        young_modulus: f64,
        mode: &str,
    ) -> PyResult<(Matrix<'py>, Vector<'py>)> {
        self.check_triangle(triangle)?;
        let (body, mode, triangle) = (&self.inner, contact_mode(mode)?, triangle as u32);
        let displacement = DVec3::from_array(displacement);
        let touch = touch::touch(body, mode, triangle, alpha, displacement, young_modulus);
        Ok((rows(py, &touch.nodal_forces)?, array(py, touch.force)))
    }

    fn surface_displacement<'py>(
        &self,
        py: Python<'py>,
        triangle: usize,
        alpha: Triple,
        nodal_forces: Rows,
        young_modulus: f64,
    ) -> PyResult<Option<Vector<'py>>> {
        self.check_triangle(triangle)?;
        let moved = touch::surface_displacement(
            &self.inner,
            triangle as u32,
            alpha,
            &nodal_forces.map(DVec3::from_array),
            young_modulus,
        );
        Ok(moved.map(|moved| array(py, moved)))
    }

    fn closest_point<'py>(
        &self,
        py: Python<'py>,
        p: Triple,
    ) -> PyResult<(u32, Vector<'py>, Vector<'py>, f64)> {
        let (found, inside) = closest::closest_point(&self.inner, finite("p", p)?, 0);
        let sign = if inside { -1.0 } else { 1.0 };
        Ok((
            found.triangle,
            PyArray1::from_slice(py, &found.alpha),
            array(py, found.point),
            sign * found.distance,
        ))
    }
}

impl Body {
    fn check_triangle(&self, triangle: usize) -> PyResult<()> {
        if triangle < self.inner.triangles.len() {
            return Ok(());
        }
        Err(PyValueError::new_err(format!(
            "triangle {triangle} is beyond the {} triangles of the body; they are numbered from 0",
            self.inner.triangles.len()
        )))
    }
}

fn node_numbers(
    name: &str,
    numbers: &PyArrayLike1<'_, i64, AllowTypeChange>,
) -> PyResult<Vec<u32>> {
    let number = |&n: &i64| {
        u32::try_from(n).map_err(|_| {
            PyValueError::new_err(format!(
                "{name} names the node {n}; nodes are numbered from 0"
            ))
        })
    };
    numbers.as_array().iter().map(number).collect()
}

/// Triangles (m, 3) as node numbers; whether the nodes exist is for others to say.
pub fn triangle_rows(given: &PyArrayLike2<'_, i64, AllowTypeChange>) -> PyResult<Vec<[u32; 3]>> {
    let triangles = given.as_array();
    if triangles.ncols() != 3 {
        return Err(misshaped("triangles", triangles.shape(), "(m, 3)"));
    }
    triangles
        .rows()
        .into_iter()
        .enumerate()
        .map(|(t, r)| {
            let index = |k: usize| {
                u32::try_from(r[k]).map_err(|_| {
                    PyValueError::new_err(format!(
                        "triangle {t} names the node {}; nodes are numbered from 0",
                        r[k]
                    ))
                })
            };
            Ok([index(0)?, index(1)?, index(2)?])
        })
        .collect()
}
