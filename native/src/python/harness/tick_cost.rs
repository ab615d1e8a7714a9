//! `tick_costs`: CPU time of the servo's ticks, with fingers that follow a script.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rtrb::RingBuffer;
use triple_buffer::triple_buffer;

use crate::clock::cpu_time::thread_seconds;
use crate::contact::cones::MAX_FINGERS;
use crate::control::safety::Limits;
use crate::device::{Device, DeviceFrame, LinkReport, Probe, Reading};
use crate::python::body::surface::Body;
use crate::python::servo::settings::contact_mode;
use crate::python::vectors::{Vector, positive};
use crate::servo::Servo;
use crate::servo::settings::{Options, Settings};
use crate::servo::snapshot::Published;

/// A device without motors that is where its script says.
struct Scripted {
    path: Arc<[DVec3]>,
    tick: usize,
}

impl Device for Scripted {
    fn read(&mut self, _now: f64, _dt: f64, _frame: &DeviceFrame) -> Reading {
        let position = self.path[self.tick.min(self.path.len() - 1)];
        let restart = self.tick == 0;
        self.tick += 1;
        Reading::At(Probe {
            position,
            orientation: DMat3::IDENTITY,
            speed: 0.0,
            restart,
            buttons: 0,
            max_force: f64::INFINITY,
        })
    }

    fn write(&mut self, _force: DVec3, _enable: bool, _frame: &DeviceFrame) {}

    fn park(&mut self) {}

    fn report(&self) -> LinkReport {
        LinkReport::default()
    }
}

/// CPU time (ticks,), s, of the servo's whole ticks with fingers on paths (fingers, ticks, 3).
///
/// ValueError for other shapes, or several fingers on a body that is not whole.
#[pyfunction]
#[pyo3(signature = (body, paths, *, young_modulus, mode="consistent"))]
pub fn tick_costs<'py>(
    py: Python<'py>,
    body: &Body,
    paths: PyArrayLike3<'_, f64, AllowTypeChange>,
    young_modulus: f64,
    mode: &str,
) -> PyResult<Vector<'py>> {
    let paths = paths.as_array();
    let [fingers, ticks, 3] = paths.shape()[..] else {
        return Err(PyValueError::new_err(
            "paths must have the shape (fingers, ticks, 3)",
        ));
    };
    if !(1..=MAX_FINGERS).contains(&fingers) || ticks == 0 {
        return Err(PyValueError::new_err(format!(
            "paths are of {fingers} fingers and {ticks} ticks; give one to {MAX_FINGERS} fingers"
        )));
    }
    if fingers > 1 && !body.inner.is_whole() {
        return Err(PyValueError::new_err(
            "several fingers need a body made with whole=True",
        ));
    }
    let mut settings = Settings::new(positive("young_modulus", young_modulus)?);
    settings.feel.mode = contact_mode(mode)?;
    let options = Options {
        rate_hz: 1000,
        limits: Limits {
            max_force: 3.0,
            max_slew: 1000.0,
            ramp_seconds: 0.25,
        },
        max_speed: 2.0,
    };
    let devices = (paths.outer_iter())
        .map(|path| {
            let places = path.rows().into_iter();
            let path = places.map(|p| DVec3::new(p[0], p[1], p[2])).collect();
            Box::new(Scripted { path, tick: 0 }) as Box<dyn Device>
        })
        .collect();
    let (_settings_in, settings_out) = triple_buffer(&settings);
    let (snapshots_in, _snapshots) = triple_buffer(&Published::before_the_start(fingers));
    let (samples_in, _nobody_takes_them) = RingBuffer::new(1);
    let mut servo = Servo::new(
        body.inner.clone(),
        devices,
        options,
        settings_out,
        snapshots_in,
        samples_in,
    );
    let costs = py.detach(|| {
        let mut costs = Vec::with_capacity(ticks);
        let mut before = thread_seconds();
        for tick in 0..ticks {
            servo.tick(tick as f64 * 1e-3);
            let after = thread_seconds();
            costs.push(after - before);
            before = after;
        }
        costs
    });
    Ok(PyArray1::from_vec(py, costs))
}
