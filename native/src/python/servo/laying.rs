//! What touches the body, and the body laid down as one that nobody holds; also while the servo runs.

use std::sync::Arc;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::pile::laid::Laid;
use crate::python::servo::refusals::check_finger;
use crate::python::servo::settings::firmness;
use crate::python::servo::thread::Servo;
use crate::python::tool::made::{GivenTool, made, tip};
use crate::servo::paced::locked;

impl Servo {
    /// Has the body be so firm.
    pub(super) fn firm(&self, energies: &[f64], shares: &[f64]) -> PyResult<()> {
        let settings = locked(&self.settings).firm(firmness(energies, shares)?);
        if let Some(running) = self.current() {
            running.set(settings);
        }
        Ok(())
    }

    /// Gives a finger a tool, or makes it a point (none).
    pub(super) fn equip(
        &self,
        py: Python<'_>,
        tool: Option<GivenTool<'_>>,
        finger: usize,
    ) -> PyResult<()> {
        check_finger(finger)?;
        let made = tool.as_ref().map(made);
        let body = locked(&self.body).clone();
        if (made.as_ref()).is_some_and(|(surface, _)| !Arc::ptr_eq(surface.body(), &body)) {
            return Err(PyValueError::new_err(
                "the tool was made for another body; make it with the Body that the servo touches",
            ));
        }
        locked(&self.tools)[finger].clone_from(&made);
        let Some(running) = self.alive().filter(|r| finger < r.finger_count()) else {
            return Ok(());
        };
        py.detach(|| running.set_tip(finger, tip(made))).map_err(|_| {
            PyRuntimeError::new_err(
                "the servo's thread has not taken the tools that it was given before; try again",
            )
        })
    }

    /// Lays the body down, or has it held (none).
    pub(super) fn laid(&self, py: Python<'_>, prop: Laid) -> PyResult<()> {
        let body = locked(&self.body).clone();
        if (prop.as_ref()).is_some_and(|prop| !prop.is(&body)) {
            return Err(PyValueError::new_err(
                "the prop was made of another body; make it of the Body that the servo touches",
            ));
        }
        locked(&self.prop).clone_from(&prop);
        let Some(running) = self.alive() else {
            return Ok(());
        };
        py.detach(|| running.lay(prop)).map_err(|_| {
            PyRuntimeError::new_err(
                "the servo's thread has not taken what was laid down before; try again",
            )
        })
    }
}
