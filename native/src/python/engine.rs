//! `ContactEngine`: fingers on a body without a clock.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::exceptions::{PyFloatingPointError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::body::surface;
use crate::contact::cones::MAX_FINGERS;
use crate::engine::goals::{Goal, PointTouch, Toucher, Unsettled};
use crate::engine::settling::Settling;
use crate::python::body::place::surface_point;
use crate::python::body::surface::Body;
use crate::python::servo::settings::contact_mode;
use crate::python::tool::shape::Tool;
use crate::python::tool::surface::ToolSurface;
use crate::python::tool::told::told_tool;
use crate::python::vectors::{array, finite, pose, positive, rows};
use crate::tool::coefficients::Friction;
use crate::tool::collider::Collider;

#[pyclass(module = "palpate_servo")]
pub struct ContactEngine {
    inner: Settling,
    body: Arc<surface::Body>,
}

#[pymethods]
impl ContactEngine {
    #[new]
    #[pyo3(signature = (body, tips, *, young_modulus, friction=0.0, mode="consistent"))]
    fn new(
        body: &Body,
        tips: Vec<Option<(PyRef<'_, ToolSurface>, PyRef<'_, Tool>)>>,
        young_modulus: f64,
        friction: f64,
        mode: &str,
    ) -> PyResult<Self> {
        if !(1..=MAX_FINGERS).contains(&tips.len()) {
            return Err(PyValueError::new_err(format!(
                "{} tips; give one to {MAX_FINGERS} fingers",
                tips.len()
            )));
        }
        if tips.len() > 1 && !body.inner.is_whole() {
            return Err(PyValueError::new_err(
                "several fingers need a whole body; make it with whole=True",
            ));
        }
        let friction = Friction::of(friction);
        if !friction.is_sound() {
            return Err(PyValueError::new_err(format!(
                "friction is {}; give a coefficient, zero or more",
                friction.sticking
            )));
        }
        let mut touchers = Vec::with_capacity(tips.len());
        for (number, tip) in tips.into_iter().enumerate() {
            touchers.push(match tip {
                None => Toucher::Point(PointTouch::default()),
                Some((surface, _)) if !Arc::ptr_eq(surface.inner.body(), &body.inner) => {
                    return Err(PyValueError::new_err(format!(
                        "tip {number} has contact points on another body; spread them on this one"
                    )));
                }
                Some((surface, tool)) => {
                    let mut tool = Collider::new(surface.inner.clone(), tool.inner.clone());
                    tool.set_friction(friction);
                    Toucher::Tool(Box::new(tool))
                }
            });
        }
        Ok(Self {
            inner: Settling::new(
                body.inner.clone(),
                touchers,
                positive("young_modulus", young_modulus)?,
                contact_mode(mode)?,
                !friction.is_none(),
            ),
            body: body.inner.clone(),
        })
    }

    #[getter]
    fn young_modulus(&self) -> f64 {
        self.inner.young_modulus
    }

    #[setter]
    fn set_young_modulus(&mut self, young_modulus: f64) -> PyResult<()> {
        self.inner.young_modulus = positive("young_modulus", young_modulus)?;
        Ok(())
    }

    fn settle<'py>(
        &mut self,
        py: Python<'py>,
        targets: Vec<Bound<'py, PyTuple>>,
    ) -> PyResult<Vec<Bound<'py, PyDict>>> {
        if targets.len() != self.inner.touchers.len() {
            return Err(PyValueError::new_err(format!(
                "{} targets; give one for each of the {} fingers",
                targets.len(),
                self.inner.touchers.len()
            )));
        }
        let goals = (targets.iter().enumerate())
            .map(|(number, target)| self.goal(number, target))
            .collect::<PyResult<Vec<Goal>>>()?;
        let inner = &mut self.inner;
        py.detach(|| inner.settle(&goals)).map_err(unsettled)?;
        let touchers = self.inner.touchers.iter();
        touchers.map(|toucher| self.told(py, toucher)).collect()
    }
}

impl ContactEngine {
    fn goal(&self, number: usize, target: &Bound<'_, PyTuple>) -> PyResult<Goal> {
        if let Ok((position, rotation)) = target.extract() {
            return Ok(Goal::Tool(pose(position, rotation)?));
        }
        let (triangle, alpha, by): (i64, [f64; 3], [f64; 3]) = target.extract().map_err(|_| {
            PyValueError::new_err(format!(
                "target {number} is neither (position, rotation) nor (triangle, alpha, by)"
            ))
        })?;
        let hold = surface_point(&self.body, &format!("target {number}"), triangle, alpha)?;
        Ok(Goal::Point(hold, finite("by", by)?))
    }

    fn told<'py>(&self, py: Python<'py>, toucher: &Toucher) -> PyResult<Bound<'py, PyDict>> {
        match toucher {
            Toucher::Point(point) => self.point(py, point),
            Toucher::Tool(tool) => told_tool(py, tool, self.inner.young_modulus),
        }
    }

    fn point<'py>(&self, py: Python<'py>, point: &PointTouch) -> PyResult<Bound<'py, PyDict>> {
        let told = PyDict::new(py);
        told.set_item("force", array(py, point.force))?;
        told.set_item("nodal_forces", rows(py, &point.nodal_forces)?)?;
        if let Some((hold, _)) = point.at {
            let nodes = self.body.triangles[hold.triangle as usize].map(i64::from);
            told.set_item("triangle", hold.triangle)?;
            told.set_item("alpha", PyArray1::from_slice(py, &hold.alpha))?;
            told.set_item("nodes", PyArray1::from_slice(py, &nodes))?;
        }
        Ok(told)
    }
}

fn unsettled(reason: Unsettled) -> PyErr {
    match reason {
        Unsettled::OtherTip(finger) => PyValueError::new_err(format!(
            "target {finger} is not one for that finger's tip; give (position, rotation) of a tool, \
             (triangle, alpha, by) of a point"
        )),
        Unsettled::TooFar(finger) => PyValueError::new_err(format!(
            "finger {finger}: the goal is too many strides away; begin nearer"
        )),
        Unsettled::NoWayOut(finger) => PyValueError::new_err(format!(
            "finger {finger}: there is no way out of the body from where it is; begin outside"
        )),
        Unsettled::NotANumber(finger) => PyFloatingPointError::new_err(format!(
            "finger {finger}: its force came out as no number; press less deep"
        )),
        Unsettled::Moving(finger, share) => PyRuntimeError::new_err(format!(
            "finger {finger}: its force does not settle, it still changes by {share:.1e} of the \
             largest one in a step; press less deep or with a rounder tool"
        )),
    }
}
