//! `SteppedFingers`: the servo's own ticks, its fingers led along paths, in a time of their own.

use std::sync::{Arc, Mutex};

use glam::DVec3;
use numpy::{AllowTypeChange, PyArray1, PyArray3, PyArrayLike2, PyArrayLike3, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::clock::cpu_time::thread_seconds;
use crate::contact::cones::MAX_FINGERS;
use crate::control::safety::Limits;
use crate::device::{Device, DeviceFrame, Probe, Reading};
use crate::python::body::surface::Body;
use crate::python::harness::stepping::Stepping;
use crate::python::pile::Lain;
use crate::python::servo::settings::{Chosen, Given, firmness};
use crate::python::servo::snapshot::Snapshot;
use crate::python::servo::told::Loads;
use crate::python::tool::made::{GivenTool, made, tip};
use crate::python::vectors::{Rows, Triple, Vector, finite, rotation as turn, vectors};
use crate::servo::paced::locked;
use crate::servo::pressed_patch::PressedPatch;
use crate::servo::settings::{Options, Settings};

/// Forces and torques (ticks, m, 3).
type Felt<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>);

/// N, N/s and m/s: beyond all that is asked for, and still a number.
const NO_LIMIT: f64 = 1e12;

/// Place of a finger in the next tick.
#[derive(Debug, Clone, Copy)]
struct Place {
    position: DVec3,
    set_down: bool,
}

/// A device that is wherever it was put.
#[derive(Clone)]
struct Led {
    place: Arc<Mutex<Place>>,
    /// N; infinite without motors.
    max_force: f64,
}

impl Device for Led {
    fn read(&mut self, _now: f64, _dt: f64, _frame: &DeviceFrame) -> Reading {
        let mut place = locked(&self.place);
        let restart = std::mem::take(&mut place.set_down);
        Reading::At(Probe {
            max_force: self.max_force,
            ..Probe::without_motors(place.position, restart)
        })
    }

    fn write(&mut self, _force: DVec3, _enable: bool, _frame: &DeviceFrame) {}

    fn park(&mut self) {}
}

struct Stepped {
    stepping: Stepping,
    led: Vec<Led>,
}

impl Stepped {
    /// Puts the fingers where they are in each tick, and has it made at its time.
    fn lead(
        &mut self,
        paths: &PyArrayLike3<'_, f64, AllowTypeChange>,
        mut tick: impl FnMut(&mut Stepping),
    ) -> PyResult<()> {
        let paths = paths.as_array();
        let (ticks, fingers, columns) = paths.dim();
        if fingers != self.led.len() || columns != 3 {
            return Err(PyValueError::new_err(format!(
                "paths have shape ({ticks}, {fingers}, {columns}), expected (ticks, {}, 3)",
                self.led.len()
            )));
        }
        for places in paths.outer_iter() {
            for (led, row) in self.led.iter().zip(places.rows()) {
                locked(&led.place).position = finite("paths", [row[0], row[1], row[2]])?;
            }
            tick(&mut self.stepping);
        }
        Ok(())
    }
}

/// The ticks of a Servo, by hand and in virtual time, with fingers led along paths.
///
/// No device, no limits; fingers are where the path says, however far apart its places lie. With a
/// `max_force`, N, they have motors that bear so much. With a `prop` the body is laid down as one that
/// nobody holds.
/// `follow(paths)` takes (ticks, m, 3), m, and gives contact forces on the fingers, N, and torques,
/// N m, (ticks, m, 3), before coupling and safety; `sent(paths)` the forces that devices are told, N,
/// (ticks, m, 3); `costs(paths)` the CPU time of each tick, s. ValueError
/// for several fingers on a body that is not whole, and for other shapes.
#[pyclass(frozen, module = "palpate_servo.harness")]
pub struct SteppedFingers(Mutex<Stepped>);

#[pymethods]
impl SteppedFingers {
    #[new]
    #[pyo3(signature = (body, positions, settings, *, rate_hz=1000, max_force=None, prop=None))]
    fn new(
        body: &Body,
        positions: PyArrayLike2<'_, f64, AllowTypeChange>,
        settings: Given,
        rate_hz: u32,
        max_force: Option<f64>,
        prop: Option<Lain<'_>>,
    ) -> PyResult<Self> {
        let places = vectors("positions", &positions)?;
        if places.is_empty() || places.len() > MAX_FINGERS {
            return Err(PyValueError::new_err(format!(
                "{} positions; a servo has 1 to {MAX_FINGERS} fingers",
                places.len()
            )));
        }
        if places.len() > 1 && !body.inner.is_whole() {
            return Err(PyValueError::new_err(
                "several fingers need a whole body; make it with whole=True",
            ));
        }
        let options = Options {
            rate_hz: rate_hz.max(1),
            limits: Limits {
                max_force: NO_LIMIT,
                max_slew: NO_LIMIT,
                ramp_seconds: 0.0,
            },
            max_speed: NO_LIMIT,
        };
        let led: Vec<Led> = (places.into_iter())
            .map(|position| {
                let set_down = true;
                Led {
                    place: Arc::new(Mutex::new(Place { position, set_down })),
                    max_force: max_force.unwrap_or(f64::INFINITY),
                }
            })
            .collect();
        let boxed = led
            .iter()
            .map(|one| -> Box<dyn Device> { Box::new(one.clone()) });
        let mut stepping = Stepping::new(body, boxed.collect(), &settings, options)?;
        if let Some(prop) = prop {
            // Nothing else is on its way yet.
            let _ = (stepping.ends.prop).give(Some(prop.lying()));
        }
        stepping.tick(Some(0.0));
        Ok(Self(Mutex::new(Stepped { stepping, led })))
    }

    fn follow<'py>(
        &self,
        py: Python<'py>,
        paths: PyArrayLike3<'py, f64, AllowTypeChange>,
    ) -> PyResult<Felt<'py>> {
        let (ticks, fingers, _) = paths.as_array().dim();
        let mut forces = Vec::with_capacity(3 * ticks * fingers);
        let mut torques = Vec::with_capacity(3 * ticks * fingers);
        locked(&self.0).lead(&paths, |stepping| {
            stepping.tick(None);
            for report in stepping.ends.snapshots.read().fingers() {
                forces.extend(report.snapshot.contact_force.to_array());
                torques.extend(report.snapshot.torque.to_array());
            }
        })?;
        let shaped = |values| PyArray1::from_vec(py, values).reshape([ticks, fingers, 3]);
        Ok((shaped(forces)?, shaped(torques)?))
    }

    fn sent<'py>(
        &self,
        py: Python<'py>,
        paths: PyArrayLike3<'py, f64, AllowTypeChange>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let (ticks, fingers, _) = paths.as_array().dim();
        let mut forces = Vec::with_capacity(3 * ticks * fingers);
        locked(&self.0).lead(&paths, |stepping| {
            stepping.tick(None);
            for report in stepping.ends.snapshots.read().fingers() {
                forces.extend(report.snapshot.output_force.to_array());
            }
        })?;
        PyArray1::from_vec(py, forces).reshape([ticks, fingers, 3])
    }

    fn costs<'py>(
        &self,
        py: Python<'py>,
        paths: PyArrayLike3<'py, f64, AllowTypeChange>,
    ) -> PyResult<Vector<'py>> {
        let mut costs = Vec::with_capacity(paths.as_array().dim().0);
        locked(&self.0).lead(&paths, |stepping| {
            let before = thread_seconds();
            stepping.tick(None);
            costs.push(thread_seconds() - before);
        })?;
        Ok(PyArray1::from_vec(py, costs))
    }

    #[pyo3(signature = (tool, rotation, finger=0))]
    fn set_tool(&self, tool: Option<GivenTool<'_>>, rotation: Rows, finger: usize) -> PyResult<()> {
        let tip = tip(tool.as_ref().map(made));
        let orientation = turn("rotation", rotation)?;
        let Stepped { stepping, led } = &mut *locked(&self.0);
        let mut settings = stepping.settings;
        let (Some(hand), Some(own)) = (
            stepping.ends.tips.get_mut(finger),
            settings.fingers.get_mut(finger),
        ) else {
            return Err(no_finger(finger, led.len()));
        };
        own.orientation = orientation;
        stepping.settings = settings;
        stepping.ends.settings.write(settings);
        hand.free_old();
        hand.give(tip).map_err(|_| {
            PyValueError::new_err("tools wait to be taken; let the fingers follow a path first")
        })
    }

    fn set_down(&self, position: Triple, finger: usize) -> PyResult<()> {
        let stepped = locked(&self.0);
        let led = (stepped.led.get(finger)).ok_or_else(|| no_finger(finger, stepped.led.len()))?;
        *locked(&led.place) = Place {
            position: finite("position", position)?,
            set_down: true,
        };
        Ok(())
    }

    fn set_firmness(&self, energies: Vec<f64>, shares: Vec<f64>) -> PyResult<()> {
        let stepping = &mut locked(&self.0).stepping;
        let settings = Settings {
            firmness: firmness(&energies, &shares)?,
            ..stepping.settings
        };
        stepping.write(settings);
        Ok(())
    }

    fn set(&self, settings: Given) -> PyResult<()> {
        let chosen = Chosen::checked(&settings)?;
        let stepping = &mut locked(&self.0).stepping;
        let before = stepping.settings;
        let mut settings = chosen.on(&before.fingers, &before);
        // A tool's rotation is set with the tool.
        for (finger, before) in settings.fingers.iter_mut().zip(&before.fingers) {
            finger.orientation = before.orientation;
        }
        stepping.write(settings);
        Ok(())
    }

    fn snapshot(&self, py: Python<'_>) -> PyResult<Py<Snapshot>> {
        let ends = &mut locked(&self.0).stepping.ends;
        // No tick goes on meanwhile: all of the same one.
        let patches = ends.patches.iter_mut();
        let patches: Vec<PressedPatch> = patches.map(|patch| patch.read().clone()).collect();
        let published = ends.snapshots.read();
        let loads = Loads {
            remembered: ends.remembered.read().nodes().to_vec(),
            borne: ends.borne.read().of_bodies(1 + published.other_count),
        };
        Snapshot::of(py, published, &patches, loads)
    }
}

fn no_finger(finger: usize, count: usize) -> PyErr {
    PyValueError::new_err(format!("there is no finger {finger}; there are {count}"))
}
