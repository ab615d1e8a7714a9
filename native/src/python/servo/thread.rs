//! `Servo`: starts, leads and stops the native thread.

use std::ops::RangeInclusive;
use std::sync::{Arc, Mutex};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::body::surface;
use crate::clock::timing::Timing;
use crate::contact::cones::MAX_FINGERS;
use crate::control::coupling::Coupling;
use crate::device::Device;
use crate::pile::laid::Laid;
use crate::python::body::surface::Body;
use crate::python::device::setups::{DeviceSetup, Lead};
use crate::python::pile::Lain;
use crate::python::servo::counters::{finger_counters, stage_counters, timing_counters};
use crate::python::servo::refusals::{NOT_WHOLE, check_kept};
use crate::python::servo::samples::{structured, structured_pieces};
use crate::python::servo::settings::{Chosen, Given, options};
use crate::python::servo::snapshot::Snapshot;
use crate::python::servo::standing::Standing;
use crate::python::servo::told::Loads;
use crate::python::tool::made::{GivenTool, MadeTool};
use crate::python::vectors::{Triple, check_seconds, finite, positive};
use crate::servo::paced::locked;
use crate::servo::settings::{FingerSettings, Options};
use crate::servo::snapshot::{Published, Sample};
use crate::servo::thread::Running;

/// Lengths of a recording, s.
const RECORDINGS: RangeInclusive<f64> = 0.0..=3600.0;

#[pyclass(frozen, module = "palpate_servo")]
pub struct Servo {
    pub(super) body: Mutex<Arc<surface::Body>>,
    pub(super) options: Options,
    pub(super) glide_speed: f64,
    pub(super) record_samples: usize,
    /// Ticks that the next start records.
    pub(super) armed_ticks: Mutex<usize>,
    pub(super) settings: Mutex<Standing>,
    pub(super) running: Mutex<Option<Arc<Running>>>,
    /// Fingers 1, 2, ... of the next start.
    pub(super) others: Mutex<Vec<Box<dyn Device>>>,
    /// Tools by finger, each on the body that it was made for.
    pub(super) tools: Mutex<[Option<MadeTool>; MAX_FINGERS]>,
    /// The body as one that nobody holds.
    pub(super) prop: Mutex<Laid>,
    /// Targets of pointers, by finger.
    pub(super) targets: Mutex<[Option<Lead>; MAX_FINGERS]>,
}

#[pymethods]
impl Servo {
    #[new]
    #[pyo3(signature = (body, settings, *, rate_hz=1000, max_force=3.0, max_slew=1000.0,
        ramp_seconds=0.25, max_speed=2.0, glide_speed=0.5, record_seconds=10.0))]
    #[allow(clippy::too_many_arguments)] // Keywords in Python.
    fn new(
        body: &Body,
        settings: Given,
        rate_hz: u32,
        max_force: f64,
        max_slew: f64,
        ramp_seconds: f64,
        max_speed: f64,
        glide_speed: f64,
        record_seconds: f64,
    ) -> PyResult<Self> {
        check_kept(record_seconds)?;
        let options = options(rate_hz, max_force, max_slew, ramp_seconds, max_speed)?;
        let brought = FingerSettings {
            coupling: Coupling::for_devices(rate_hz),
            ..FingerSettings::default()
        };
        let standing = Standing::new(Chosen::checked(&settings)?, [brought; MAX_FINGERS]);
        Ok(Self {
            body: Mutex::new(body.inner.clone()),
            options,
            glide_speed: positive("glide_speed", glide_speed)?,
            record_samples: (record_seconds * f64::from(rate_hz)).ceil() as usize,
            armed_ticks: Mutex::new(0),
            settings: Mutex::new(standing),
            running: Mutex::new(None),
            others: Mutex::default(),
            tools: Mutex::default(),
            prop: Mutex::default(),
            targets: Mutex::default(),
        })
    }

    fn set(&self, settings: Given) -> PyResult<()> {
        let chosen = Chosen::checked(&settings)?;
        let settings = locked(&self.settings).choose(chosen);
        if let Some(running) = self.current() {
            running.set(settings);
        }
        Ok(())
    }

    fn set_firmness(&self, energies: Vec<f64>, shares: Vec<f64>) -> PyResult<()> {
        self.firm(&energies, &shares)
    }

    fn start(&self, py: Python<'_>, device: DeviceSetup<'_>) -> PyResult<()> {
        if self.alive().is_some() {
            return Err(PyRuntimeError::new_err(
                "the servo runs already; stop it before starting it again",
            ));
        }
        let first = self.opened(py, 0, &device)?;
        self.run(py, first)
    }

    fn add(&self, py: Python<'_>, device: DeviceSetup<'_>) -> PyResult<usize> {
        let finger = self.next_finger()?;
        let device = self.opened(py, finger, &device)?;
        let mut others = locked(&self.others);
        others.truncate(finger - 1);
        others.push(device);
        Ok(finger)
    }

    #[getter]
    fn finger_count(&self) -> usize {
        match self.alive() {
            Some(running) => running.finger_count(),
            None => 1 + locked(&self.others).len(),
        }
    }

    #[pyo3(signature = (position, restart=false, finger=0))]
    fn set_target(&self, position: Triple, restart: bool, finger: usize) -> PyResult<()> {
        let position = finite("position", position)?;
        let mut targets = locked(&self.targets);
        match targets.get_mut(finger).and_then(Option::as_mut) {
            Some((input, last)) => {
                *last = last.next(position, restart);
                input.write(*last);
                Ok(())
            }
            None => Err(PyRuntimeError::new_err(format!(
                "targets lead a pointer, and finger {finger} is none; call start(Pointer(...)) \
                 first, or add(Pointer(...))"
            ))),
        }
    }

    #[pyo3(signature = (tool, finger=0))]
    fn set_tool(&self, py: Python<'_>, tool: Option<GivenTool<'_>>, finger: usize) -> PyResult<()> {
        self.equip(py, tool, finger)
    }

    fn lay(&self, py: Python<'_>, prop: Option<Lain<'_>>) -> PyResult<()> {
        self.laid(py, prop.as_ref().map(Lain::lying))
    }

    fn set_body(&self, py: Python<'_>, body: &Body, settings: Given) -> PyResult<()> {
        let chosen = Chosen::checked(&settings)?;
        let body = body.inner.clone();
        let is_enough = self.finger_count() == 1 || body.is_whole();
        if !is_enough {
            return Err(PyValueError::new_err(NOT_WHOLE));
        }
        // Whoever waits for a lock in here may hold the interpreter's.
        py.detach(|| {
            let mut standing = locked(&self.settings);
            let settings = standing.choose(chosen);
            (*locked(&self.body)).clone_from(&body);
            // Tools and props are made for one body.
            *locked(&self.tools) = Default::default();
            *locked(&self.prop) = None;
            if let Some(running) = self.current() {
                running.set_body(body, settings);
            }
        });
        Ok(())
    }

    fn snapshot(&self, py: Python<'_>) -> PyResult<Py<Snapshot>> {
        let Some(running) = self.current() else {
            return Snapshot::of(py, &Published::before_the_start(1), &[], Loads::default());
        };
        let (published, patches) = running.published_with_patches();
        let loads = Loads {
            remembered: running.remembered(),
            borne: running.borne(published.other_count),
        };
        Snapshot::of(py, &published, &patches, loads)
    }

    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let samples = self.current().map(|r| r.drain()).unwrap_or_default();
        structured(py, &samples)
    }

    #[pyo3(signature = (seconds=600.0))]
    fn start_recording(&self, py: Python<'_>, seconds: f64) -> PyResult<usize> {
        check_seconds("seconds", positive("seconds", seconds)?, RECORDINGS)?;
        let ticks = (seconds * f64::from(self.options.rate_hz)).ceil() as usize;
        let samples = ticks.saturating_mul(self.finger_count());
        match self.alive() {
            Some(running) if running.recorder().is_on() => {
                return Err(PyRuntimeError::new_err(
                    "a recording is on already; call stop_recording first",
                ));
            }
            Some(running) => py.detach(|| running.recorder().start(samples))?,
            None => *locked(&self.armed_ticks) = ticks,
        }
        Ok(samples.saturating_mul(size_of::<Sample>()))
    }

    fn stop_recording(&self, py: Python<'_>) {
        *locked(&self.armed_ticks) = 0;
        if let Some(running) = self.current() {
            py.detach(|| running.recorder().stop());
        }
    }

    fn recording<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self.current() {
            Some(running) => running
                .recorder()
                .read(|pieces| structured_pieces(py, pieces)),
            None => structured(py, &[]),
        }
    }

    #[getter]
    fn recording_lost(&self) -> u64 {
        self.current().map_or(0, |r| r.recorder().lost())
    }

    #[getter]
    fn is_recording(&self) -> bool {
        self.current().is_some_and(|r| r.recorder().is_on())
    }

    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let running = self.current();
        let counters = match &running {
            Some(running) => {
                let paced = running.paced();
                timing_counters(py, paced.timing(), &paced.realtime())?
            }
            None => timing_counters(py, &Timing::default(), "not started")?,
        };
        let published = running
            .as_ref()
            .map_or_else(|| Published::before_the_start(1), |r| r.published());
        let stages = running.as_deref().map(Running::stages);
        counters.set_item("stages_us", stage_counters(py, stages)?)?;
        counters.set_item("rate_hz", self.options.rate_hz)?;
        counters.set_item("samples_lost", published.samples_lost)?;
        finger_counters(py, &counters, published.first())?;
        let fingers = published.fingers().iter().map(|report| {
            let finger = PyDict::new(py);
            finger_counters(py, &finger, report)?;
            Ok(finger)
        });
        counters.set_item("fingers", fingers.collect::<PyResult<Vec<_>>>()?)?;
        Ok(counters)
    }

    fn stop(&self, py: Python<'_>) {
        if let Some(running) = self.current() {
            py.detach(|| {
                running.paced().stop();
                running.recorder().stop();
            });
        }
        *locked(&self.targets) = Default::default();
    }

    #[getter]
    fn running(&self) -> bool {
        self.alive().is_some()
    }

    fn __enter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __exit__(
        &self,
        py: Python<'_>,
        _kind: &Bound<'_, PyAny>,
        _value: &Bound<'_, PyAny>,
        _trace: &Bound<'_, PyAny>,
    ) {
        self.stop(py);
    }
}
