//! `Resting`: a body that nobody holds, with tools and supports, without a clock.

use glam::{DMat3, DVec3};
use numpy::PyArray1;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::python::body::place::surface_point;
use crate::python::rest::prop::{Laid, Prop, collider, placed};
use crate::python::tool::told::told_tool;
use crate::python::vectors::{
    Matrix, Rows, Triple, Vector, array, finite, pose, positive, rows, square, table,
};
use crate::rest::finger::{Finger, Point};
use crate::rest::prop;
use crate::rest::resting::{self, Restless};
use crate::rest::settling::{Settling, settle};

#[pyclass(module = "palpate_servo")]
pub struct Resting {
    inner: resting::Resting,
    settling: Option<Settling>,
}

#[pymethods]
impl Resting {
    #[new]
    #[pyo3(signature = (prop, *, young_modulus, fingers))]
    fn new(prop: &Prop, young_modulus: f64, fingers: Vec<Given<'_>>) -> PyResult<Self> {
        if fingers.len() > MAX_FINGERS {
            return Err(PyValueError::new_err(format!(
                "{} fingers; at most {MAX_FINGERS} may press a body",
                fingers.len()
            )));
        }
        let prop = prop.inner.clone();
        let fingers = (fingers.into_iter().enumerate())
            .map(|(number, given)| given.on(number, &prop))
            .collect::<PyResult<Vec<_>>>()?;
        let modulus = positive("young_modulus", young_modulus)?;
        Ok(Self {
            inner: resting::Resting::new(modulus, prop, fingers),
            settling: None,
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

    fn set_young_modulus(&mut self, young_modulus: f64) -> PyResult<()> {
        let modulus = positive("young_modulus", young_modulus)?;
        self.settling = None;
        self.inner.set_young_modulus(modulus);
        Ok(())
    }

    fn laid(&self) -> Prop {
        Prop {
            inner: self.inner.prop.clone(),
        }
    }

    fn place(&mut self, position: Triple, rotation: Rows) -> PyResult<()> {
        let pose = pose(position, rotation)?;
        self.settling = None;
        self.inner.place(placed(&pose));
        Ok(())
    }

    fn lead(&mut self, number: usize, position: Triple, rotation: Rows) -> PyResult<()> {
        let goal = pose(position, rotation)?;
        let finger = (self.inner.fingers.get_mut(number))
            .ok_or_else(|| PyValueError::new_err(format!("there is no finger {number}")))?;
        match finger {
            Finger::Tool(_, pose) => *pose = goal,
            Finger::Point(point) => point.goal = goal.position,
        }
        self.settling = None;
        Ok(())
    }

    fn lead_support(&mut self, number: usize, position: Triple, rotation: Rows) -> PyResult<()> {
        let goal = pose(position, rotation)?;
        let support = (self.inner.prop.supports.get_mut(number))
            .ok_or_else(|| PyValueError::new_err(format!("there is no support {number}")))?;
        support.pose = goal;
        self.settling = None;
        Ok(())
    }

    #[pyo3(signature = (dt, *, hurried=false))]
    fn tick(&mut self, dt: f64, hurried: bool) -> PyResult<()> {
        let dt = positive("dt", dt)?;
        self.settling = None;
        self.inner.tick(dt, hurried).map(drop).map_err(restless)
    }

    fn come_in(&mut self, py: Python<'_>) -> PyResult<()> {
        self.settling = None;
        py.detach(|| self.inner.come_in()).map_err(restless)
    }

    fn settle(&mut self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| settle(&mut self.inner)).map_err(restless)
    }

    /// Goes on with coming to rest by so many ticks; whether it rests.
    fn settle_on(&mut self, py: Python<'_>, ticks: usize) -> PyResult<bool> {
        let settling = (self.settling).get_or_insert_with(|| Settling::of(&self.inner));
        let inner = &mut self.inner;
        py.detach(|| settling.go_on(inner, ticks)).map_err(restless)
    }

    fn touches<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let modulus = self.inner.young_modulus();
        let fingers = self.inner.fingers.iter().map(|finger| match finger {
            Finger::Tool(tool, _) => told_tool(py, tool, modulus),
            Finger::Point(point) => told_point(py, &self.inner.prop.body, point, modulus),
        });
        let supports = self.inner.prop.supports.iter();
        let supports = supports.map(|support| told_tool(py, &support.collider, modulus));
        fingers.chain(supports).collect()
    }
}

/// A finger of Python's: a tool as it is laid; or a point, its triangle, area coordinates there, the
/// friction with which it presses (none: it holds the place) and where the place is to go.
#[derive(FromPyObject)]
enum Given<'py> {
    Tool(Laid<'py>),
    Point((i64, Triple, Option<f64>, Triple)),
}

impl Given<'_> {
    fn on(self, number: usize, prop: &prop::Prop) -> PyResult<Finger> {
        match self {
            Self::Tool(laid) => {
                collider(&prop.body, laid).map(|(tool, pose)| Finger::Tool(Box::new(tool), pose))
            }
            Self::Point((triangle, alpha, friction, goal)) => Ok(Finger::Point(Point {
                hold: surface_point(&prop.body, &format!("finger {number}"), triangle, alpha)?,
                friction,
                goal: finite("goal", goal)?,
                force: DVec3::ZERO,
                energy: 0.0,
            })),
        }
    }
}

/// What a point felt, in N; it presses no contact points with an area.
fn told_point<'py>(
    py: Python<'py>,
    body: &Body,
    point: &Point,
    modulus: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    let force = point.force * modulus;
    let nodes = body.triangles[point.hold.triangle as usize].map(i64::from);
    told.set_item("force", array(py, -force))?;
    told.set_item("torque", array(py, DVec3::ZERO))?;
    told.set_item("free", true)?;
    for places in ["places", "displacements"] {
        told.set_item(places, table(py, std::iter::empty())?)?;
    }
    for numbers in ["pushes", "areas"] {
        told.set_item(numbers, PyArray1::<f64>::zeros(py, 0, false))?;
    }
    told.set_item("nodes", PyArray1::from_slice(py, &nodes))?;
    told.set_item(
        "nodal_forces",
        rows(py, &point.hold.alpha.map(|share| force * share))?,
    )?;
    Ok(told)
}

pub fn restless(reason: Restless) -> PyErr {
    PyRuntimeError::new_err(match reason {
        Restless::NotANumber => "a force came out as no number; press less deep".to_string(),
        Restless::Moving(time, speed) => format!(
            "after {time:.3} s the body still moves by {speed:.1e} m/s; nothing may bear it, or it \
             slides or rolls without end"
        ),
    })
}
