//! `Pile`: soft bodies that press each other, without a clock.

use glam::{DMat3, DVec3};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::contact::ground::MOST_BODIES;
use crate::pile::among::Among;
use crate::pile::contact::{Against, Contact};
use crate::pile::laid::Lying;
use crate::pile::member::Member;
use crate::pile::obstacle::Obstacle;
use crate::pile::piled;
use crate::python::rest::prop::{Prop, placed};
use crate::python::rest::resting::restless;
use crate::python::tool::shape::Tool;
use crate::python::tool::surface::ToolSurface;
use crate::python::vectors::{
    Matrix, Rows, Triple, Vector, array, finite, matrix, pose, positive, square, table,
};
use crate::rest::free_body::FreeBody;
use crate::rest::settling::{Settling, settle};
use crate::tool::coefficients::Friction;
use crate::tool::points::touchable::Touchable;

/// A body: its contact points, those of hands if they are others, Young's modulus, mass, centre, moments
/// of inertia, drag time and whether a hand steadies it, if it is free, and where its frame is.
type Laid<'py> = (
    PyRef<'py, ToolSurface>,
    Option<PyRef<'py, ToolSurface>>,
    f64,
    Option<(f64, Triple, Rows, f64, bool)>,
    Triple,
    Rows,
);
/// A rigid tool, where it is, the coefficient of friction, and whether a hand leads it.
type Rigid<'py> = (PyRef<'py, Tool>, Triple, Rows, f64, bool);

#[pyclass(module = "palpate_servo")]
pub struct Pile {
    inner: piled::Pile,
    settling: Option<Settling>,
}

/// A body that nobody holds, among others that it presses.
#[pyclass(frozen, module = "palpate_servo")]
pub struct PropAmong {
    inner: Lying,
}

/// A body as Python lays it down.
#[derive(FromPyObject)]
pub enum Lain<'py> {
    Alone(PyRef<'py, Prop>),
    Among(PyRef<'py, PropAmong>),
}

impl Lain<'_> {
    /// Itself, for a servo.
    pub fn lying(&self) -> Box<Lying> {
        Box::new(match self {
            Self::Alone(prop) => Lying::Alone(prop.inner.clone()),
            Self::Among(among) => among.inner.clone(),
        })
    }
}

#[pymethods]
impl Pile {
    #[new]
    #[pyo3(signature = (bodies, obstacles, *, gravity, friction))]
    fn new(
        bodies: Vec<Laid<'_>>,
        obstacles: Vec<Rigid<'_>>,
        gravity: Triple,
        friction: f64,
    ) -> PyResult<Self> {
        let members = bodies.into_iter().map(member).collect::<PyResult<_>>()?;
        let obstacles = obstacles
            .into_iter()
            .map(obstacle)
            .collect::<PyResult<_>>()?;
        let gravity = finite("gravity", gravity)?;
        let friction = coefficient(friction)?;
        Ok(Self {
            inner: piled::Pile::new(members, obstacles, gravity, friction),
            settling: None,
        })
    }

    #[getter]
    fn time(&self) -> f64 {
        self.inner.time()
    }

    fn position<'py>(&self, py: Python<'py>, body: usize) -> PyResult<Vector<'py>> {
        Ok(array(py, self.member(body)?.placement.position))
    }

    fn rotation<'py>(&self, py: Python<'py>, body: usize) -> PyResult<Matrix<'py>> {
        square(py, DMat3::from_quat(self.member(body)?.placement.rotation))
    }

    fn set_young_modulus(&mut self, body: usize, young_modulus: f64) -> PyResult<()> {
        let modulus = positive("young_modulus", young_modulus)?;
        let _ = self.member(body)?;
        self.settling = None;
        self.inner.members[body].young_modulus = modulus;
        Ok(())
    }

    fn elastic(&self, body: usize) -> PyResult<f64> {
        Ok(self.member(body)?.elastic())
    }

    /// Contacts that press, an array for each thing about them.
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let pressed: Vec<&Contact> = (self.inner.contacts().iter())
            .filter(|contact| contact.push > 0.0)
            .collect();
        let told = PyDict::new(py);
        let numbers = |of: &dyn Fn(&Contact) -> i64| {
            let found: Vec<i64> = pressed.iter().map(|contact| of(contact)).collect();
            PyArray1::from_vec(py, found)
        };
        told.set_item("body", numbers(&|contact| contact.body as i64))?;
        told.set_item("point", numbers(&|contact| i64::from(contact.point)))?;
        told.set_item(
            "obstacle",
            numbers(&|contact| match contact.against {
                Against::Obstacle(number) => number as i64,
                Against::Finger(_) | Against::Body(_) => -1,
            }),
        )?;
        told.set_item(
            "other",
            numbers(&|contact| match contact.against {
                Against::Finger(_) | Against::Obstacle(_) => -1,
                Against::Body(number) => number as i64,
            }),
        )?;
        let pushes: Vec<f64> = pressed.iter().map(|contact| contact.push).collect();
        told.set_item("push", PyArray1::from_vec(py, pushes))?;
        let forces: Vec<DVec3> = pressed.iter().map(|contact| contact.force()).collect();
        told.set_item("force", table(py, forces.into_iter())?)?;
        let members = &self.inner.members;
        let places: Vec<DVec3> = (pressed.iter())
            .map(|contact| members[contact.body].place(contact.point))
            .collect();
        told.set_item("place", table(py, places.into_iter())?)?;
        let mut shared: [Vec<i64>; 2] = [Vec::new(), Vec::new()];
        let mut shares = Vec::new();
        for (number, contact) in pressed.iter().enumerate() {
            for &(point, share) in contact.shares.iter() {
                shared[0].push(number as i64);
                shared[1].push(i64::from(point));
                shares.push(share);
            }
        }
        let [contact, point] = shared;
        told.set_item("shared_contact", PyArray1::from_vec(py, contact))?;
        told.set_item("shared_point", PyArray1::from_vec(py, point))?;
        told.set_item("share", PyArray1::from_vec(py, shares))?;
        Ok(told)
    }

    fn laid(&self) -> PyResult<PropAmong> {
        let count = self.inner.members.len();
        if count > MOST_BODIES {
            return Err(PyValueError::new_err(format!(
                "{count} bodies press each other; in a servo at most {MOST_BODIES} may"
            )));
        }
        let among = Among::new(self.inner.clone());
        Ok(PropAmong {
            inner: Lying::Among(among),
        })
    }

    fn lead(&mut self, obstacle: usize, position: Triple, rotation: Rows) -> PyResult<()> {
        let goal = pose(position, rotation)?;
        let led = (self.inner.obstacles.get_mut(obstacle))
            .ok_or_else(|| PyValueError::new_err(format!("there is no obstacle {obstacle}")))?;
        led.goal = goal;
        self.settling = None;
        Ok(())
    }

    fn tick(&mut self, dt: f64) -> PyResult<()> {
        let dt = positive("dt", dt)?;
        self.settling = None;
        self.inner.tick(dt).map_err(restless)
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
}

impl Pile {
    fn member(&self, body: usize) -> PyResult<&Member> {
        (self.inner.members.get(body))
            .ok_or_else(|| PyValueError::new_err(format!("there is no body {body}")))
    }
}

fn member((surface, closer, modulus, free, position, rotation): Laid<'_>) -> PyResult<Member> {
    let free = free
        .map(|(mass, centre, inertia, drag_time, is_steady)| {
            let free = FreeBody {
                mass,
                centre: finite("centre", centre)?,
                inertia: matrix(inertia),
                drag_time,
                is_steady,
            };
            if free.is_sound() {
                Ok(free)
            } else {
                Err(PyValueError::new_err(
                    "mass, inertia and drag_time are not those of a body; give positive ones",
                ))
            }
        })
        .transpose()?;
    let placement = placed(&pose(position, rotation)?);
    Ok(Member::new(
        Touchable::new(
            surface.inner.clone(),
            closer.map(|closer| closer.inner.clone()),
        ),
        positive("young_modulus", modulus)?,
        free,
        placement,
    ))
}

fn obstacle((tool, position, rotation, friction, is_hand): Rigid<'_>) -> PyResult<Obstacle> {
    let pose = pose(position, rotation)?;
    Ok(Obstacle::new(
        tool.inner.clone(),
        pose,
        coefficient(friction)?,
        is_hand,
    ))
}

fn coefficient(friction: f64) -> PyResult<f64> {
    if Friction::of(friction).is_sound() {
        Ok(friction)
    } else {
        Err(PyValueError::new_err(format!(
            "friction is {friction}; give a coefficient, zero or more"
        )))
    }
}
