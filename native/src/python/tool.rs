//! `Tool`, `ToolSurface`, and `ToolContact`: a tool on a body alone, step by step.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLike2, PyArrayLike3};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::vectors::{
    Matrix, Rows, Triple, Vector, array, finite, positive, rotation, square, table,
};
use crate::body::surface;
use crate::engine::lone::LoneTool;
use crate::python::body::surface::Body;
use crate::python::tool_cost::Timing;
use crate::servo::tip::Tip;
use crate::tool::collider::Collider;
use crate::tool::friction::Friction;
use crate::tool::near_field::{NearField, NodeField, PointField};
use crate::tool::points::{self, Point};
use crate::tool::shape::{self, Pose};

type Numbers<'py> = Bound<'py, PyArray1<i64>>;

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

    #[getter]
    fn radius(&self) -> f64 {
        self.inner.radius()
    }

    #[getter]
    fn reach(&self) -> f64 {
        self.inner.reach()
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
                "normals, triangles, alphas and areas must have a row for each of the {count} positions"
            )));
        }
        let points = (0..count)
            .map(|i| {
                let triangle = usize::try_from(triangles[i]).ok();
                let nodes = triangle.and_then(|t| body.inner.triangles.get(t));
                let nodes = *nodes.ok_or_else(|| {
                    PyValueError::new_err(format!(
                        "contact point {i} is on triangle {}, beyond the {} of the body",
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

    #[getter]
    fn point_count(&self) -> usize {
        self.inner.points().len()
    }

    #[getter]
    fn spacing(&self) -> f64 {
        self.inner.spacing()
    }
}

/// The arrays that `core/contact/near_field/compliance_beneath.py` gives.
const NEAR_FIELD: [&str; 14] = [
    "believed",
    "short",
    "poisson_ratio",
    "normals",
    "edges",
    "softness",
    "regular",
    "slopes",
    "excess",
    "far_nodes",
    "far_weights",
    "shares",
    "softness_of_points",
    "own",
];

/// From the arrays that `core/contact/near_field/compliance_beneath.py` names.
fn near_field(arrays: &Bound<'_, PyDict>) -> PyResult<NearField> {
    // A servo that is older than core would leave out a part of the field, and press wrongly.
    for name in arrays.keys() {
        let name: String = name.extract()?;
        if !NEAR_FIELD.contains(&name.as_str()) {
            return Err(PyValueError::new_err(format!(
                "near has {name}, which this palpate_servo does not know; install the one that \
                 belongs to this palpate (make package, or make test from the source)"
            )));
        }
    }
    let array = |name: &'static str| {
        arrays.get_item(name)?.ok_or_else(|| {
            PyValueError::new_err(format!("near has no {name}; give what native_tool gives"))
        })
    };
    let numbers = |name| -> PyResult<Vec<f64>> {
        let given = array(name)?.extract::<PyArrayLike1<'_, f64, AllowTypeChange>>()?;
        Ok(given.as_array().to_vec())
    };
    let blocks = |name| -> PyResult<Vec<DMat3>> { matrices(name, &array(name)?.extract()?) };
    let limits = |name| -> PyResult<[f64; 2]> { array(name)?.extract() };
    let (believed, short) = (limits("believed")?, limits("short")?);
    let poisson_ratio: f64 = array("poisson_ratio")?.extract()?;
    let normals = vectors("normals", &array("normals")?.extract()?)?;
    let (edges, softness, regular) = (numbers("edges")?, numbers("softness")?, blocks("regular")?);
    let (slopes, excess) = (blocks("slopes")?, numbers("excess")?);
    let far_nodes = array("far_nodes")?.extract::<PyArrayLike2<'_, i64>>()?;
    let far_weights = vectors("far_weights", &array("far_weights")?.extract()?)?;
    let [shares, softness_of_points] = [numbers("shares")?, numbers("softness_of_points")?];
    let own = blocks("own")?;
    let (nodes, points) = (normals.len(), shares.len());
    if [edges.len(), softness.len(), regular.len(), excess.len()] != [nodes; 4]
        || far_nodes.as_array().dim() != (nodes, 3)
        || far_weights.len() != nodes
        || slopes.len() != 3 * nodes
        || [softness_of_points.len(), own.len()] != [points; 2]
    {
        return Err(PyValueError::new_err(
            "near must have a row for each node of the surface (three of slopes) and one for each \
             contact point",
        ));
    }
    let node = |k: usize| NodeField {
        normal: normals[k],
        edge: edges[k],
        softness: softness[k],
        excess: excess[k],
        regular: regular[k],
        slope: [0, 1, 2].map(|axis| slopes[3 * k + axis]),
        // What is no number of a node is found to be unsound with the rest.
        far_nodes: [0, 1, 2]
            .map(|c| u32::try_from(far_nodes.as_array()[[k, c]]).unwrap_or(u32::MAX)),
        far_weights: far_weights[k].to_array(),
    };
    let point = |k: usize| PointField {
        share: shares[k],
        softness: softness_of_points[k],
        own: own[k],
    };
    Ok(NearField {
        nodes: (0..nodes).map(node).collect(),
        points: (0..points).map(point).collect(),
        believed,
        short,
        poisson_ratio,
    })
}

#[pyclass(module = "palpate_servo")]
pub struct ToolContact {
    pub inner: LoneTool,
    young_modulus: f64,
}

/// What a finger takes of a tool: which it is, and the contact points that it meets.
#[derive(Clone)]
pub struct MadeTool {
    surface: Arc<points::ToolSurface>,
    tool: shape::Tool,
}

impl MadeTool {
    pub fn is_for(&self, body: &Arc<surface::Body>) -> bool {
        Arc::ptr_eq(self.surface.body(), body)
    }
}

/// A tip with all its memory; a point for no tool.
pub fn tip(made: Option<MadeTool>) -> Tip {
    made.map_or(Tip::Point, |made| {
        Tip::Tool(Box::new(Collider::new(made.surface, made.tool)))
    })
}

impl ToolContact {
    pub fn made(&self) -> MadeTool {
        MadeTool {
            surface: self.inner.surface().clone(),
            tool: self.inner.tool().clone(),
        }
    }

    fn pressed(&self) -> impl Iterator<Item = &crate::tool::patch::Slot> {
        self.inner.pressed().iter()
    }
}

#[pymethods]
impl ToolContact {
    #[new]
    #[pyo3(signature = (surface, tool, *, friction=0.0))]
    fn new(surface: &ToolSurface, tool: &Tool, friction: f64) -> PyResult<Self> {
        let friction = Friction::of(friction);
        if !friction.is_sound() {
            return Err(PyValueError::new_err(format!(
                "friction is {}; give a coefficient, zero or more",
                friction.sticking
            )));
        }
        let mut inner = LoneTool::new(surface.inner.clone(), tool.inner.clone());
        inner.set_friction(friction);
        Ok(Self {
            inner,
            young_modulus: 1.0,
        })
    }

    fn restart(&mut self, position: Triple, rotation: Rows) -> PyResult<()> {
        let pose = pose(position, rotation)?;
        self.inner.restart(&pose);
        Ok(())
    }

    fn follow(&mut self, position: Triple, rotation: Rows, young_modulus: f64) -> PyResult<()> {
        let goal = pose(position, rotation)?;
        self.young_modulus = positive("young_modulus", young_modulus)?;
        (self.inner.follow(&goal, young_modulus))
            .map(|_| ())
            .map_err(|_| PyValueError::new_err("the contact came out as no number"))
    }

    #[pyo3(signature = (positions, rotations, young_modulus, *, replay_over=None, control=0.0))]
    fn time_path<'py>(
        &mut self,
        py: Python<'py>,
        positions: PyArrayLike2<'_, f64, AllowTypeChange>,
        rotations: PyArrayLike3<'_, f64, AllowTypeChange>,
        young_modulus: f64,
        replay_over: Option<f64>,
        control: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        self.young_modulus = positive("young_modulus", young_modulus)?;
        let positions = vectors("positions", &positions)?;
        let rotations = matrices("rotations", &rotations)?;
        if positions.len() != rotations.len() {
            return Err(PyValueError::new_err(
                "rotations must be as many as positions",
            ));
        }
        let poses: Vec<Pose> = (positions.into_iter().zip(rotations))
            .map(|(position, rotation)| Pose { position, rotation })
            .collect();
        let timing = Timing {
            young_modulus,
            replay_over: replay_over.unwrap_or(f64::INFINITY),
            control,
        };
        let inner = &mut self.inner;
        let costs = py.detach(|| timing.of_path(inner, &poses));
        costs.map_err(PyRuntimeError::new_err)?.into_dict(py)
    }

    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.inner.felt().force)
    }

    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.inner.felt().torque)
    }

    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        square(py, self.inner.felt().stiffness)
    }

    #[getter]
    fn linearisations(&self) -> usize {
        self.inner.felt().linearisations
    }

    #[getter]
    fn exact(&self) -> bool {
        self.inner.felt().exact
    }

    #[getter]
    fn free(&self) -> bool {
        self.inner.is_free()
    }

    #[getter]
    fn touching(&self) -> bool {
        self.inner.felt().pressed > 0
    }

    #[getter]
    fn near_count(&self) -> usize {
        self.inner.felt().effort.near
    }

    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Option<Vector<'py>> {
        self.inner.pose().map(|pose| array(py, pose.position))
    }

    #[getter]
    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Option<Matrix<'py>>> {
        (self.inner.pose())
            .map(|pose| square(py, pose.rotation))
            .transpose()
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        PyArray1::from_iter(py, self.pressed().map(|slot| i64::from(slot.point)))
    }

    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let scale = self.young_modulus;
        table(py, self.pressed().map(|slot| slot.force * scale))
    }

    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        table(py, self.pressed().map(|slot| slot.normal))
    }

    #[getter]
    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        table(py, self.pressed().map(|slot| slot.moved))
    }

    #[getter]
    fn pressures<'py>(&self, py: Python<'py>) -> Vector<'py> {
        let pressure =
            |slot: &crate::tool::patch::Slot| slot.push * self.young_modulus / slot.at.area;
        PyArray1::from_iter(py, self.pressed().map(pressure))
    }

    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        let nodes = self.inner.nodal_forces().iter();
        PyArray1::from_iter(py, nodes.map(|&(node, _)| i64::from(node)))
    }

    #[getter]
    fn nodal_forces<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let forces = self.inner.nodal_forces().iter();
        table(py, forces.map(|&(_, force)| force * self.young_modulus))
    }
}

pub fn pose(position: Triple, rows: Rows) -> PyResult<Pose> {
    Ok(Pose {
        position: finite("position", position)?,
        rotation: rotation("rotation", rows)?,
    })
}

fn vectors(name: &str, array: &PyArrayLike2<'_, f64, AllowTypeChange>) -> PyResult<Vec<DVec3>> {
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

fn matrices(name: &str, array: &PyArrayLike3<'_, f64, AllowTypeChange>) -> PyResult<Vec<DMat3>> {
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
