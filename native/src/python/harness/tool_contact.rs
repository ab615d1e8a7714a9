//! `ToolContact`: a tool on a body alone, tick by tick; as the servo's fingers have it.

use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::engine::lone::LoneTool;
use crate::python::tool::shape::Tool;
use crate::python::tool::surface::ToolSurface;
use crate::python::vectors::{Matrix, Rows, Triple, Vector, array, pose, positive, square, table};
use crate::tool::coefficients::Friction;
use crate::tool::slot::Slot;

type Numbers<'py> = Bound<'py, PyArray1<i64>>;

/// A tool on a body alone, tick by tick.
///
/// `restart` sets it down; `follow(position, rotation, young_modulus)` goes towards a pose by at most one
/// stride, and feels the body (Pa) there. Forces on the tool, N, and torques, N m; of the p pressed contact
/// points their numbers, forces on the body, the tool's normals, and pressures, Pa; of the nodes that
/// carry force, these. ValueError for a friction below zero, poses that are none and forces without
/// sense.
#[pyclass(module = "palpate_servo.harness")]
pub struct ToolContact {
    pub inner: LoneTool,
    pub young_modulus: f64,
}

impl ToolContact {
    fn pressed(&self) -> impl Iterator<Item = &Slot> {
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
    fn free(&self) -> bool {
        self.inner.is_free()
    }

    #[getter]
    fn touching(&self) -> bool {
        self.inner.felt().pressed > 0
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
    fn pressures<'py>(&self, py: Python<'py>) -> Vector<'py> {
        let pressure = |slot: &Slot| slot.push * self.young_modulus / slot.at.area;
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
