//! `Servo`: starts, leads and stops the native thread.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use glam::{DMat3, DVec3};
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use triple_buffer::{Input, triple_buffer};

use super::body::Body;
use super::counters::{link_counters, stage_counters, timing_counters};
use super::haply::haply_setup;
use super::snapshot::{Snapshot, structured, structured_pieces};
use super::stepped::fault_counters;
use super::tool::ToolContact;
use super::vectors::{IDENTITY, Rows, Triple, check_rate, check_seconds, finite, matrix, positive};
use crate::clock::Timing;
use crate::cones::MAX_FINGERS;
use crate::contact::ContactMode;
use crate::coupling::Coupling;
use crate::device::{Device, DeviceFrame};
use crate::felt::Felt;
use crate::finger::FingerSettings;
use crate::haply::device::HaplyDevice;
use crate::link::LinkDevice;
use crate::pointer::{Pointer, Target};
use crate::port::SerialPort;
use crate::proxy::Feel;
use crate::safety::Limits;
use crate::servo::{Options, Settings};
use crate::snapshot::{Published, Sample, Told};
use crate::surface;
use crate::thread::Running;
use crate::tip::Tip;
use crate::tool;
use crate::tool::points::ToolSurface;
use crate::tool::shape::Tool;

/// Why there can be no more than one finger.
const NOT_WHOLE: &str = "several fingers need the compliance of any two nodes, which this body has \
    not kept; make it with Body(..., whole=True)";

/// Every servo that may still run, so that the interpreter's exit can stop it.
static STARTED: Mutex<Vec<Weak<Running>>> = Mutex::new(Vec::new());

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

type MadeTool = (Arc<ToolSurface>, Tool);

/// Where a pointer is led, and where it was led last.
type Lead = (Input<Target>, Target);

#[pyclass(frozen, module = "palpate_servo")]
pub struct Servo {
    body: Mutex<Arc<surface::Body>>,
    options: Options,
    glide_speed: f64,
    record_samples: usize,
    /// What the next start shall record.
    armed_ticks: Mutex<usize>,
    settings: Mutex<Settings>,
    /// The user's, if one was set; else that of the device.
    own_coupling: Mutex<Option<Coupling>>,
    running: Mutex<Option<Arc<Running>>>,
    /// Fingers 1, 2, ... of the next start.
    others: Mutex<Vec<Box<dyn Device>>>,
    /// By finger: its tool, on the body that it was made for.
    tools: Mutex<[Option<MadeTool>; MAX_FINGERS]>,
    /// Of pointers, by finger.
    targets: Mutex<[Option<Lead>; MAX_FINGERS]>,
}

impl Servo {
    fn current(&self) -> Option<Arc<Running>> {
        locked(&self.running).clone()
    }

    fn published(&self) -> Published {
        self.current()
            .map_or_else(|| Published::before_the_start(1), |r| r.published())
    }

    fn change(&self, edit: impl FnOnce(&mut Settings)) {
        let mut settings = locked(&self.settings);
        edit(&mut settings);
        if let Some(running) = self.current() {
            running.set(*settings);
        }
    }

    fn refuse_if_running(&self) -> PyResult<()> {
        match self.current() {
            Some(running) if running.paced().is_running() => Err(PyRuntimeError::new_err(
                "the servo runs already; stop it before starting it again",
            )),
            _ => Ok(()),
        }
    }

    /// The device that `open` finds at `port`, for a finger.
    fn open_port<D: Device + 'static>(
        &self,
        py: Python<'_>,
        finger: usize,
        port: SerialPort,
        frame: DeviceFrame,
        encoder_step: f64,
        open: impl FnOnce(SerialPort) -> std::io::Result<D> + Send,
    ) -> PyResult<Box<dyn Device>> {
        let device = py.detach(|| {
            let path = port.path.clone();
            open(port).map_err(|e| {
                PyOSError::new_err(format!(
                    "{path}: cannot be opened ({e}); close the program that uses it, or see \
                         'palpate devices'"
                ))
            })
        })?;
        let mut settings = locked(&self.settings);
        settings.fingers[finger].frame = frame;
        settings.fingers[finger].coupling = locked(&self.own_coupling)
            .unwrap_or_else(|| Coupling::for_encoders(self.options.rate_hz, encoder_step));
        locked(&self.targets)[finger] = None;
        Ok(Box::new(device))
    }

    /// A pointer for a finger, set down at a position.
    fn new_pointer(&self, finger: usize, position: DVec3) -> Box<dyn Device> {
        let start = Target::first(position);
        let (input, output) = triple_buffer(&start);
        locked(&self.targets)[finger] = Some((input, start));
        Box::new(Pointer::new(start, output, self.glide_speed))
    }

    /// The number of the next finger but the first.
    fn next_finger(&self) -> PyResult<usize> {
        if self.current().is_some_and(|r| r.paced().is_running()) {
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

    fn add(&self, finger: usize, device: Box<dyn Device>) -> usize {
        let mut others = locked(&self.others);
        others.truncate(finger - 1);
        others.push(device);
        finger
    }

    /// Starts with this device as finger 0.
    fn start(&self, py: Python<'_>, first: Box<dyn Device>) -> PyResult<()> {
        let mut devices = vec![first];
        devices.append(&mut locked(&self.others));
        let settings = *locked(&self.settings);
        let armed_ticks = *locked(&self.armed_ticks);
        let tools = locked(&self.tools).clone();
        let running = py.detach(|| {
            Running::start_with_tips(
                locked(&self.body).clone(),
                devices,
                tools.into_iter().map(tip).collect(),
                self.options,
                settings,
                (self.record_samples, armed_ticks),
            )
            .map_err(no_thread)
        })?;
        *locked(&self.armed_ticks) = 0;
        let running = Arc::new(running);
        let mut started = locked(&STARTED);
        started.retain(|weak| weak.strong_count() > 0);
        started.push(Arc::downgrade(&running));
        *locked(&self.running) = Some(running);
        Ok(())
    }
}

#[pymethods]
impl Servo {
    #[new]
    #[pyo3(signature = (body, *, young_modulus, rate_hz=1000, max_force=3.0, max_slew=1000.0,
        ramp_seconds=0.25, max_speed=2.0, glide_speed=0.5, record_seconds=10.0, shading=false,
        static_friction=0.0, dynamic_friction=0.0, mode="consistent", felt="linear"))]
    #[allow(clippy::too_many_arguments)] // Keywords in Python.
    fn new(
        body: &Body,
        young_modulus: f64,
        rate_hz: u32,
        max_force: f64,
        max_slew: f64,
        ramp_seconds: f64,
        max_speed: f64,
        glide_speed: f64,
        record_seconds: f64,
        shading: bool,
        static_friction: f64,
        dynamic_friction: f64,
        mode: &str,
        felt: &str,
    ) -> PyResult<Self> {
        check_rate(rate_hz)?;
        check_seconds("ramp_seconds", ramp_seconds)?;
        check_seconds("record_seconds", record_seconds)?;
        Ok(Self {
            body: Mutex::new(body.inner.clone()),
            options: Options {
                rate_hz,
                limits: Limits {
                    max_force: positive("max_force", max_force)?,
                    max_slew: positive("max_slew", max_slew)?,
                    ramp_seconds,
                },
                max_speed: positive("max_speed", max_speed)?,
            },
            glide_speed: positive("glide_speed", glide_speed)?,
            record_samples: (record_seconds * f64::from(rate_hz)).ceil() as usize,
            armed_ticks: Mutex::new(0),
            settings: Mutex::new(Settings {
                feel: feel(
                    shading,
                    static_friction,
                    dynamic_friction,
                    contact_mode(mode)?,
                )?,
                felt: felt_choice(felt)?,
                fingers: [FingerSettings {
                    coupling: Coupling::for_devices(rate_hz),
                    ..FingerSettings::default()
                }; MAX_FINGERS],
                ..Settings::new(positive("young_modulus", young_modulus)?)
            }),
            own_coupling: Mutex::new(None),
            running: Mutex::new(None),
            others: Mutex::default(),
            tools: Mutex::default(),
            targets: Mutex::default(),
        })
    }

    fn start_pointer(&self, py: Python<'_>, position: Triple) -> PyResult<()> {
        self.refuse_if_running()?;
        let position = finite("position", position)?;
        let pointer = self.new_pointer(0, position);
        self.start(py, pointer)
    }

    #[pyo3(signature = (port, *, baud=115_200, rotation=IDENTITY, translation=[0.0; 3], scale=1.0))]
    fn start_serial(
        &self,
        py: Python<'_>,
        port: String,
        baud: u32,
        rotation: Rows,
        translation: Triple,
        scale: f64,
    ) -> PyResult<()> {
        self.refuse_if_running()?;
        let frame = device_frame(rotation, translation, scale)?;
        let port = SerialPort { path: port, baud };
        let device = self.open_port(py, 0, port, frame, 0.0, LinkDevice::open)?;
        self.start(py, device)
    }

    #[pyo3(signature = (
        port, *, model="2diy-3.1", angles=None, recalibrate=false, baud=115_200,
        rotation=IDENTITY, translation=[0.0; 3], scale=1.0
    ))]
    #[allow(clippy::too_many_arguments)] // Keywords in Python.
    fn start_haply(
        &self,
        py: Python<'_>,
        port: String,
        model: &str,
        angles: Option<[f32; 2]>,
        recalibrate: bool,
        baud: u32,
        rotation: Rows,
        translation: Triple,
        scale: f64,
    ) -> PyResult<()> {
        self.refuse_if_running()?;
        let (model, calibration) = haply_setup(model, angles, recalibrate, baud)?;
        let frame = device_frame(rotation, translation, scale)?;
        let (port, step) = (SerialPort { path: port, baud }, model.encoder_step());
        let device = self.open_port(py, 0, port, frame, step, |port| {
            HaplyDevice::open(port, model, calibration)
        })?;
        self.start(py, device)
    }

    fn add_pointer(&self, position: Triple) -> PyResult<usize> {
        let finger = self.next_finger()?;
        let pointer = self.new_pointer(finger, finite("position", position)?);
        Ok(self.add(finger, pointer))
    }

    #[pyo3(signature = (port, *, baud=115_200, rotation=IDENTITY, translation=[0.0; 3], scale=1.0))]
    fn add_serial(
        &self,
        py: Python<'_>,
        port: String,
        baud: u32,
        rotation: Rows,
        translation: Triple,
        scale: f64,
    ) -> PyResult<usize> {
        let finger = self.next_finger()?;
        let frame = device_frame(rotation, translation, scale)?;
        let port = SerialPort { path: port, baud };
        let device = self.open_port(py, finger, port, frame, 0.0, LinkDevice::open)?;
        Ok(self.add(finger, device))
    }

    #[pyo3(signature = (
        port, *, model="2diy-3.1", angles=None, recalibrate=false, baud=115_200,
        rotation=IDENTITY, translation=[0.0; 3], scale=1.0
    ))]
    #[allow(clippy::too_many_arguments)] // Keywords in Python.
    fn add_haply(
        &self,
        py: Python<'_>,
        port: String,
        model: &str,
        angles: Option<[f32; 2]>,
        recalibrate: bool,
        baud: u32,
        rotation: Rows,
        translation: Triple,
        scale: f64,
    ) -> PyResult<usize> {
        let finger = self.next_finger()?;
        let (model, calibration) = haply_setup(model, angles, recalibrate, baud)?;
        let frame = device_frame(rotation, translation, scale)?;
        let (port, step) = (SerialPort { path: port, baud }, model.encoder_step());
        let device = self.open_port(py, finger, port, frame, step, |port| {
            HaplyDevice::open(port, model, calibration)
        })?;
        Ok(self.add(finger, device))
    }

    #[getter]
    fn finger_count(&self) -> usize {
        match self.current().filter(|r| r.paced().is_running()) {
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
                "targets lead a pointer, and finger {finger} is none; call start_pointer first, or \
                 add_pointer"
            ))),
        }
    }

    #[pyo3(signature = (rotation, finger=0))]
    fn set_orientation(&self, rotation: Rows, finger: usize) -> PyResult<()> {
        check_finger(finger)?;
        let rotation = rotation_matrix(rotation)?;
        self.change(|s| s.fingers[finger].orientation = rotation);
        Ok(())
    }

    #[pyo3(signature = (tool, finger=0))]
    fn set_tool(
        &self,
        py: Python<'_>,
        tool: Option<PyRef<'_, ToolContact>>,
        finger: usize,
    ) -> PyResult<()> {
        check_finger(finger)?;
        let made = tool.map(|tool| (tool.inner.surface().clone(), tool.inner.tool().clone()));
        let fits = |(surface, _): &MadeTool| Arc::ptr_eq(surface.body(), &locked(&self.body));
        if made.as_ref().is_some_and(|made| !fits(made)) {
            return Err(PyValueError::new_err(
                "the tool was made for another body; make it with the Body that the servo touches",
            ));
        }
        locked(&self.tools)[finger].clone_from(&made);
        let Some(running) = self.current().filter(|r| finger < r.finger_count()) else {
            return Ok(());
        };
        py.detach(|| running.set_tip(finger, tip(made))).map_err(|_| {
            PyRuntimeError::new_err(
                "the servo's thread has not taken the tools that it was given before; try again",
            )
        })
    }

    fn set_young_modulus(&self, young_modulus: f64) -> PyResult<()> {
        let young_modulus = positive("young_modulus", young_modulus)?;
        self.change(|s| s.young_modulus = young_modulus);
        Ok(())
    }

    fn set_body(&self, py: Python<'_>, body: &Body, young_modulus: f64) -> PyResult<()> {
        let young_modulus = positive("young_modulus", young_modulus)?;
        let body = body.inner.clone();
        let is_enough = self.finger_count() == 1 || body.is_whole();
        if !is_enough {
            return Err(PyValueError::new_err(NOT_WHOLE));
        }
        // Whoever waits for a lock in here may hold the interpreter's.
        py.detach(|| {
            let mut settings = locked(&self.settings);
            settings.young_modulus = young_modulus;
            (*locked(&self.body)).clone_from(&body);
            // Tools are made for one body.
            *locked(&self.tools) = Default::default();
            if let Some(running) = self.current() {
                running.set_body(body, *settings);
            }
        });
        Ok(())
    }

    #[pyo3(signature = (rotation, translation, scale, finger=0))]
    fn set_device_frame(
        &self,
        rotation: Rows,
        translation: Triple,
        scale: f64,
        finger: usize,
    ) -> PyResult<()> {
        check_finger(finger)?;
        let frame = device_frame(rotation, translation, scale)?;
        self.change(|s| s.fingers[finger].move_device(frame));
        Ok(())
    }

    #[pyo3(signature = (*, shading, static_friction, dynamic_friction))]
    fn set_feel(&self, shading: bool, static_friction: f64, dynamic_friction: f64) -> PyResult<()> {
        let feel = feel(
            shading,
            static_friction,
            dynamic_friction,
            ContactMode::default(),
        )?;
        self.change(|s| {
            s.feel = Feel {
                mode: s.feel.mode,
                ..feel
            }
        });
        Ok(())
    }

    fn set_mode(&self, mode: &str) -> PyResult<()> {
        let mode = contact_mode(mode)?;
        self.change(|s| s.feel.mode = mode);
        Ok(())
    }

    fn set_felt(&self, felt: &str) -> PyResult<()> {
        let felt = felt_choice(felt)?;
        self.change(|s| s.felt = felt);
        Ok(())
    }

    #[pyo3(signature = (*, stiffness, damping, passivity_control))]
    fn set_coupling(&self, stiffness: f64, damping: f64, passivity_control: bool) -> PyResult<()> {
        let coupling = coupling(stiffness, damping, passivity_control)?;
        *locked(&self.own_coupling) = Some(coupling);
        self.change(|s| {
            for finger in &mut s.fingers {
                finger.coupling = coupling;
            }
        });
        Ok(())
    }

    fn set_enabled(&self, enabled: bool) {
        self.change(|s| s.enabled = enabled);
    }

    fn snapshot(&self) -> Snapshot {
        match self.current() {
            Some(running) => {
                let (published, patches) = running.published_with_patches();
                Snapshot::of(&published, patches)
            }
            None => Snapshot::of(&Published::before_the_start(1), Vec::new()),
        }
    }

    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let samples = self.current().map(|r| r.drain()).unwrap_or_default();
        structured(py, &samples)
    }

    #[pyo3(signature = (seconds=600.0))]
    fn start_recording(&self, py: Python<'_>, seconds: f64) -> PyResult<usize> {
        check_seconds("seconds", positive("seconds", seconds)?)?;
        let ticks = (seconds * f64::from(self.options.rate_hz)).ceil() as usize;
        let samples = ticks.saturating_mul(self.finger_count());
        match self.current().filter(|r| r.paced().is_running()) {
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
        let published = self.published();
        let stages = running.as_deref().map(Running::stages);
        counters.set_item("stages_us", stage_counters(py, stages)?)?;
        counters.set_item("rate_hz", self.options.rate_hz)?;
        counters.set_item("samples_lost", published.samples_lost)?;
        count_finger(py, &counters, published.first())?;
        let fingers = published.fingers().iter().map(|told| {
            let finger = PyDict::new(py);
            count_finger(py, &finger, told)?;
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
        self.current().is_some_and(|r| r.paced().is_running())
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

/// A tip with all its memory; a point for no tool.
fn tip(made: Option<MadeTool>) -> Tip {
    made.map_or(Tip::Point, |(surface, tool)| {
        Tip::Tool(Box::new(tool::contact::ToolContact::new(surface, tool)))
    })
}

/// What one finger has counted.
fn count_finger(py: Python<'_>, counters: &Bound<'_, PyDict>, told: &Told) -> PyResult<()> {
    counters.set_item("faults", fault_counters(py, told)?)?;
    counters.set_item("link", link_counters(py, &told.link)?)?;
    let proxy = PyDict::new(py);
    proxy.set_item("most_steps", told.most_steps)?;
    proxy.set_item("rescues", told.rescues)?;
    counters.set_item("proxy", proxy)
}

fn check_finger(finger: usize) -> PyResult<()> {
    if finger < MAX_FINGERS {
        return Ok(());
    }
    Err(PyValueError::new_err(format!(
        "finger is {finger}; a servo has fingers 0 to {}",
        MAX_FINGERS - 1
    )))
}

fn orthonormal(rows: Rows, refusal: &'static str) -> PyResult<DMat3> {
    let found = matrix(rows);
    let error = found * found.transpose() - DMat3::IDENTITY;
    if error.to_cols_array().iter().all(|e| e.abs() < 1e-6) {
        Ok(found)
    } else {
        Err(PyValueError::new_err(refusal))
    }
}

fn rotation_matrix(rows: Rows) -> PyResult<DMat3> {
    let refusal = "rotation is none; its rows must be orthonormal and right-handed";
    let found = orthonormal(rows, refusal)?;
    if found.determinant() > 0.0 {
        Ok(found)
    } else {
        Err(PyValueError::new_err(refusal))
    }
}

pub(super) fn device_frame(
    rotation: Rows,
    translation: Triple,
    scale: f64,
) -> PyResult<DeviceFrame> {
    Ok(DeviceFrame {
        rotation: orthonormal(
            rotation,
            "rotation is not orthonormal; a device frame may turn and scale, not shear",
        )?,
        translation: finite("translation", translation)?,
        scale: positive("scale", scale)?,
        epoch: 0,
    })
}

pub(super) fn contact_mode(name: &str) -> PyResult<ContactMode> {
    let found = ContactMode::ALL
        .into_iter()
        .find(|mode| mode.name() == name);
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "mode is {name:?}; it must be \"paper\" or \"consistent\""
        ))
    })
}

pub(super) fn felt_choice(name: &str) -> PyResult<Felt> {
    let found = Felt::ALL.into_iter().find(|felt| felt.name() == name);
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "felt is {name:?}; it must be \"linear\" or \"corrected\""
        ))
    })
}

pub(super) fn feel(
    shading: bool,
    static_friction: f64,
    dynamic_friction: f64,
    mode: ContactMode,
) -> PyResult<Feel> {
    let are_coefficients = static_friction.is_finite() && dynamic_friction >= 0.0;
    if !are_coefficients || dynamic_friction > static_friction {
        return Err(PyValueError::new_err(
            "friction must be 0 <= dynamic_friction <= static_friction",
        ));
    }
    Ok(Feel {
        shading,
        static_friction,
        dynamic_friction,
        mode,
    })
}

pub(super) fn coupling(
    stiffness: f64,
    damping: f64,
    passivity_control: bool,
) -> PyResult<Coupling> {
    if stiffness.is_nan() || stiffness <= 0.0 {
        return Err(PyValueError::new_err(
            "stiffness must be more than 0 N/m; infinite for none",
        ));
    }
    if !damping.is_finite() || damping < 0.0 {
        return Err(PyValueError::new_err(
            "damping must be finite and at least 0 N s/m",
        ));
    }
    Ok(Coupling {
        stiffness,
        damping,
        passivity_control,
    })
}

fn no_thread(error: std::io::Error) -> PyErr {
    PyOSError::new_err(format!(
        "the system gives the servo no thread ({error}); close other programs and start again"
    ))
}

/// Stops every servo that still runs; called at the interpreter's exit.
#[pyfunction]
pub fn stop_all(py: Python<'_>) {
    let started = std::mem::take(&mut *locked(&STARTED));
    py.detach(|| {
        for running in started.iter().filter_map(Weak::upgrade) {
            running.paced().stop();
        }
    });
}
