//! `Prop`: a body that nobody holds, where it lies and what bears it.

use std::sync::Arc;

use glam::DQuat;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::body::surface;
use crate::contact::ground::MOST_SUPPORTS;
use crate::python::body::surface::Body;
use crate::python::tool::shape::Tool;
use crate::python::tool::surface::ToolSurface;
use crate::python::vectors::{Rows, Triple, finite, matrix, pose};
use crate::rest::free_body::FreeBody;
use crate::rest::placement::Placement;
use crate::rest::prop;
use crate::tool::coefficients::Friction;
use crate::tool::collider::Collider;
use crate::tool::shape::Pose;

/// A tool on a body, where it is, and the coefficient of friction between the two.
pub type Laid<'py> = (PyRef<'py, ToolSurface>, PyRef<'py, Tool>, Triple, Rows, f64);

#[pyclass(frozen, module = "palpate_servo")]
pub struct Prop {
    pub inner: prop::Prop,
}

#[pymethods]
impl Prop {
    #[new]
    #[pyo3(signature = (body, *, mass, centre, inertia, drag_time, is_steady, gravity, supports, position, rotation))]
    #[expect(clippy::too_many_arguments, reason = "named, all of them, in Python")]
    fn new(
        body: &Body,
        mass: f64,
        centre: Triple,
        inertia: Rows,
        drag_time: f64,
        is_steady: bool,
        gravity: Triple,
        supports: Vec<Laid<'_>>,
        position: Triple,
        rotation: Rows,
    ) -> PyResult<Self> {
        if supports.len() > MOST_SUPPORTS {
            return Err(PyValueError::new_err(format!(
                "{} supports; at most {MOST_SUPPORTS} may bear a body",
                supports.len()
            )));
        }
        if !body.inner.is_whole() {
            return Err(PyValueError::new_err(
                "a body that nobody holds needs the compliance of any two nodes, which this one has not \
                 kept; make it with Body(..., whole=True)",
            ));
        }
        let free = FreeBody {
            mass,
            centre: finite("centre", centre)?,
            inertia: matrix(inertia),
            drag_time,
            is_steady,
        };
        if !free.is_sound() {
            return Err(PyValueError::new_err(
                "mass, inertia and drag_time are not those of a body; give positive ones",
            ));
        }
        let supports = (supports.into_iter())
            .map(|laid| {
                collider(&body.inner, laid).map(|(collider, pose)| prop::Support { collider, pose })
            })
            .collect::<PyResult<Vec<_>>>()?;
        Ok(Self {
            inner: prop::Prop {
                body: body.inner.clone(),
                free,
                placement: placed(&pose(position, rotation)?),
                gravity: finite("gravity", gravity)?,
                supports,
            },
        })
    }
}

/// The frame of a body that is so posed.
pub fn placed(pose: &Pose) -> Placement {
    Placement {
        position: pose.position,
        rotation: DQuat::from_mat3(&pose.rotation).normalize(),
    }
}

/// A tool as Python lays it, with its pose.
pub fn collider(
    body: &Arc<surface::Body>,
    (surface, tool, position, rotation, friction): Laid<'_>,
) -> PyResult<(Collider, Pose)> {
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
