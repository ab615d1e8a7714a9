//! The start of a servo: devices opened, fingers counted, the thread begun.

use std::sync::Arc;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::contact::cones::MAX_FINGERS;
use crate::control::coupling::Coupling;
use crate::device::Device;
use crate::python::device::setups::DeviceSetup;
use crate::python::servo::refusals::{NOT_WHOLE, no_thread};
use crate::python::servo::started::remember;
use crate::python::servo::thread::Servo;
use crate::python::tool::made::tip;
use crate::servo::paced::locked;
use crate::servo::thread::Running;

impl Servo {
    pub(super) fn current(&self) -> Option<Arc<Running>> {
        locked(&self.running).clone()
    }

    /// While its thread lives.
    pub(super) fn alive(&self) -> Option<Arc<Running>> {
        self.current().filter(|r| r.paced().is_running())
    }

    /// The device of a finger, open, with what it brings: its frame and coupling, or its targets.
    pub(super) fn opened(
        &self,
        py: Python<'_>,
        finger: usize,
        device: &DeviceSetup<'_>,
    ) -> PyResult<Box<dyn Device>> {
        let opened = device.open(py, self.glide_speed)?;
        if let Some((frame, encoder_step)) = opened.mount {
            let coupling = Coupling::for_encoders(self.options.rate_hz, encoder_step);
            locked(&self.settings).bring(finger, frame, coupling);
        }
        locked(&self.targets)[finger] = opened.lead;
        Ok(opened.device)
    }

    /// The number of the next finger but the first.
    pub(super) fn next_finger(&self) -> PyResult<usize> {
        if self.alive().is_some() {
            return Err(PyRuntimeError::new_err(
                "the servo runs already; stop it, add the fingers, then start it again",
            ));
        }
        if !locked(&self.body).is_whole() {
            return Err(PyValueError::new_err(NOT_WHOLE));
        }
        let number = 1 + locked(&self.others).len();
        if number < MAX_FINGERS {
            Ok(number)
        } else {
            Err(PyValueError::new_err(format!(
                "a servo has at most {MAX_FINGERS} fingers; start another one with its own body"
            )))
        }
    }

    /// Runs with this device as finger 0.
    pub(super) fn run(&self, py: Python<'_>, first: Box<dyn Device>) -> PyResult<()> {
        let mut devices = vec![first];
        devices.append(&mut locked(&self.others));
        let settings = locked(&self.settings).settings;
        let armed_ticks = *locked(&self.armed_ticks);
        let tools = locked(&self.tools).clone();
        let prop = locked(&self.prop).clone();
        let running = py.detach(|| {
            Running::start_with_tips(
                locked(&self.body).clone(),
                devices,
                tools.into_iter().map(tip).collect(),
                prop,
                self.options,
                settings,
                (self.record_samples, armed_ticks),
            )
            .map_err(no_thread)
        })?;
        *locked(&self.armed_ticks) = 0;
        let running = Arc::new(running);
        remember(&running);
        *locked(&self.running) = Some(running);
        Ok(())
    }
}
