//! `Resting`: a body that nobody holds, with tools and supports, without a clock.

use glam::{DMat3, DQuat};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::body::surface;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::MOST_SUPPORTS;
use crate::python::body::surface::Body;
use crate::python::tool::shape::Tool;
use crate::python::tool::surface::ToolSurface;
use crate::python::tool::told::told_tool;
use crate::python::vectors::{
    Matrix, Rows, Triple, Vector, array, finite, matrix, pose, positive, square,
};
use crate::rest::free_body::FreeBody;
use crate::rest::placement::Placement;
use crate::rest::prop::{Prop, Support};
use crate::rest::resting::{self, Restless};
use crate::tool::coefficients::Friction;
use crate::tool::collider::Collider;
use std::sync::Arc;

/// A tool on a body, where it is, and the coefficient of friction between the two.
type Laid<'py> = (PyRef<'py, ToolSurface>, PyRef<'py, Tool>, Triple, Rows, f64);

#[pyclass(module = "palpate_servo")]
pub struct Resting {
    inner: resting::Resting,
}

#[pymethods]
impl Resting {
    #[new]
    #[pyo3(signature = (body, *, mass, centre, inertia, young_modulus, drag_time, gravity, tools, supports))]
    #[expect(clippy::too_many_arguments, reason = "named, all of them, in Python")]
    fn new(
        body: &Body,
        mass: f64,
        centre: Triple,
        inertia: Rows,
        young_modulus: f64,
        drag_time: f64,
        gravity: Triple,
        tools: Vec<Laid<'_>>,
        supports: Vec<Laid<'_>>,
    ) -> PyResult<Self> {
        if tools.len() > MAX_FINGERS || supports.len() > MOST_SUPPORTS {
            return Err(PyValueError::new_err(format!(
                "{} tools and {} supports; at most {MAX_FINGERS} and {MOST_SUPPORTS} may touch a body",
                tools.len(),
                supports.len()
            )));
        }
        let free = FreeBody {
            mass,
            centre: finite("centre", centre)?,
            inertia: matrix(inertia),
            drag_time,
        };
        if !free.is_sound() {
            return Err(PyValueError::new_err(
                "mass, inertia and drag_time are not those of a body; give positive ones",
            ));
        }
        let fingers = (tools.into_iter())
            .map(|laid| collider(&body.inner, laid))
            .collect::<PyResult<Vec<_>>>()?;
        let supports = (supports.into_iter())
            .map(|laid| {
                collider(&body.inner, laid).map(|(collider, pose)| Support { collider, pose })
            })
            .collect::<PyResult<Vec<_>>>()?;
        let prop = Prop {
            free,
            placement: Placement::default(),
            gravity: finite("gravity", gravity)?,
            supports,
        };
        let modulus = positive("young_modulus", young_modulus)?;
        Ok(Self {
            inner: resting::Resting::new(body.inner.clone(), modulus, prop, fingers),
        })
    }

    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Vector<'py> {
        array(py, self.inner.prop.placement.position)
    }

    #[getter]
    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        square(py, DMat3::from_quat(self.inner.prop.placement.rotation))
    }

    #[getter]
    fn elastic(&self) -> f64 {
        self.inner.elastic()
    }

    #[getter]
    fn time(&self) -> f64 {
        self.inner.time()
    }

    fn place(&mut self, position: Triple, rotation: Rows) -> PyResult<()> {
        let pose = pose(position, rotation)?;
        self.inner.place(Placement {
            position: pose.position,
            rotation: DQuat::from_mat3(&pose.rotation).normalize(),
        });
        Ok(())
    }

    fn lead_tool(&mut self, number: usize, position: Triple, rotation: Rows) -> PyResult<()> {
        let goal = pose(position, rotation)?;
        let (_, pose) = (self.inner.fingers.get_mut(number))
            .ok_or_else(|| PyValueError::new_err(format!("there is no tool {number}")))?;
        *pose = goal;
        Ok(())
    }

    fn lead_support(&mut self, number: usize, position: Triple, rotation: Rows) -> PyResult<()> {
        let goal = pose(position, rotation)?;
        let support = (self.inner.prop.supports.get_mut(number))
            .ok_or_else(|| PyValueError::new_err(format!("there is no support {number}")))?;
        support.pose = goal;
        Ok(())
    }

    #[pyo3(signature = (dt, *, hurried=false))]
    fn tick(&mut self, dt: f64, hurried: bool) -> PyResult<()> {
        let dt = positive("dt", dt)?;
        self.inner.tick(dt, hurried).map(drop).map_err(restless)
    }

    fn come_in(&mut self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.inner.come_in()).map_err(restless)
    }

    fn settle(&mut self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.inner.settle()).map_err(restless)
    }

    fn touches<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let modulus = self.inner.young_modulus();
        let tools = self.inner.fingers.iter().map(|(tool, _)| tool);
        let supports = self.inner.prop.supports.iter();
        tools
            .chain(supports.map(|support| &support.collider))
            .map(|tool| told_tool(py, tool, modulus))
            .collect()
    }
}

fn collider(
    body: &Arc<surface::Body>,
    (surface, tool, position, rotation, friction): Laid<'_>,
) -> PyResult<(Collider, crate::tool::shape::Pose)> {
    if !Arc::ptr_eq(surface.inner.body(), body) {
        return Err(PyValueError::new_err(
            "a tool has contact points on another body; spread them on this one",
        ));
    }
    let coefficient = Friction::of(friction);
    if !coefficient.is_sound() {
        return Err(PyValueError::new_err(format!(
            "friction is {friction}; give a coefficient, zero or more"
        )));
    }
    let mut collider = Collider::new(surface.inner.clone(), tool.inner.clone());
    collider.set_friction(coefficient);
    Ok((collider, pose(position, rotation)?))
}

fn restless(reason: Restless) -> PyErr {
    PyRuntimeError::new_err(match reason {
        Restless::NotANumber => "a force came out as no number; press less deep".to_string(),
        Restless::Moving(time, speed) => format!(
            "after {time:.3} s the body still moves by {speed:.1e} m/s; nothing may bear it, or it \
             slides or rolls without end"
        ),
    })
}
