//! The thin binding: arrays in, arrays out. Nothing of Python reaches the servo thread.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use glam::{DMat3, DVec3};
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike2, PyArrayLike3};
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict, PyList};
use triple_buffer::{Input, triple_buffer};

use crate::clock::{BUCKETS, LATE_LIMITS_NS, Timing, bucket_limit_ns};
use crate::device::{DeviceFrame, Fault, LinkReport};
use crate::link::LinkDevice;
use crate::pointer::{Pointer, Target};
use crate::port::SerialPort;
use crate::safety::Limits;
use crate::servo::{Options, Published, Sample, Settings, State};
use crate::thread::{Paced, Running};
use crate::{closest, codec, contact, proxy, surface};

type Triple = [f64; 3];
type Rows = [[f64; 3]; 3];
const IDENTITY: Rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Every servo that may still run, so that the interpreter's exit can stop it.
static STARTED: Mutex<Vec<Weak<Running>>> = Mutex::new(Vec::new());

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn finite(name: &str, v: Triple) -> PyResult<DVec3> {
    let v = DVec3::from_array(v);
    if v.is_finite() {
        Ok(v)
    } else {
        Err(PyValueError::new_err(format!(
            "{name} has a coordinate that is not finite"
        )))
    }
}

fn positive(name: &str, value: f64) -> PyResult<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(PyValueError::new_err(format!(
            "{name} is {value}; it must be finite and greater than zero"
        )))
    }
}

fn array<'py>(py: Python<'py>, v: DVec3) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, &v.to_array())
}

fn rows<'py>(py: Python<'py>, m: &[DVec3; 3]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    Ok(PyArray2::from_vec2(py, &m.map(|v| v.to_array().to_vec()))?)
}

#[pyclass(frozen, module = "palpate_servo")]
struct Body {
    inner: Arc<surface::Body>,
}

#[pymethods]
impl Body {
    #[new]
    fn new(
        nodes: PyArrayLike2<'_, f64, AllowTypeChange>,
        triangles: PyArrayLike2<'_, i64, AllowTypeChange>,
        contact_blocks: PyArrayLike3<'_, f64, AllowTypeChange>,
    ) -> PyResult<Self> {
        let (nodes, triangles, blocks) = (
            nodes.as_array(),
            triangles.as_array(),
            contact_blocks.as_array(),
        );
        if nodes.ncols() != 3 || triangles.ncols() != 3 {
            return Err(PyValueError::new_err(
                "nodes and triangles must have three columns",
            ));
        }
        if blocks.shape()[1..] != [3, 3] {
            return Err(PyValueError::new_err(
                "contact_blocks must have the shape (nodes, 3, 3)",
            ));
        }
        let nodes = nodes
            .rows()
            .into_iter()
            .map(|r| DVec3::new(r[0], r[1], r[2]))
            .collect();
        let triangles = triangles
            .rows()
            .into_iter()
            .enumerate()
            .map(|(t, r)| {
                let index = |k: usize| {
                    u32::try_from(r[k]).map_err(|_| {
                        PyValueError::new_err(format!("triangle {t} names the node {}", r[k]))
                    })
                };
                Ok([index(0)?, index(1)?, index(2)?])
            })
            .collect::<PyResult<_>>()?;
        let blocks = blocks
            .outer_iter()
            .map(|b| DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| b[[r, c]]))))
            .collect();
        let inner = surface::Body::new(nodes, triangles, blocks)
            .map_err(|e| PyValueError::new_err(e.to_string()))?;
        Ok(Self {
            inner: Arc::new(inner),
        })
    }

    #[getter]
    fn node_count(&self) -> usize {
        self.inner.nodes.len()
    }

    #[getter]
    fn triangle_count(&self) -> usize {
        self.inner.triangles.len()
    }

    fn contact<'py>(
        &self,
        py: Python<'py>,
        triangle: usize,
        alpha: Triple,
        displacement: Triple,
        young_modulus: f64,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>)> {
        if triangle >= self.inner.triangles.len() {
            return Err(PyValueError::new_err(format!(
                "triangle {triangle} is beyond the {} triangles of the body",
                self.inner.triangles.len()
            )));
        }
        let touch = contact::touch(
            &self.inner,
            triangle as u32,
            alpha,
            DVec3::from_array(displacement),
            young_modulus,
        );
        Ok((rows(py, &touch.nodal_forces)?, array(py, touch.force)))
    }

    #[allow(clippy::type_complexity)] // A tuple is what Python gets.
    fn closest_point<'py>(
        &self,
        py: Python<'py>,
        p: Triple,
    ) -> PyResult<(
        u32,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<f64>>,
        f64,
    )> {
        let (found, inside) = closest::closest_point(&self.inner, finite("p", p)?, 0);
        let sign = if inside { -1.0 } else { 1.0 };
        Ok((
            found.triangle,
            PyArray1::from_slice(py, &found.alpha),
            array(py, found.point),
            sign * found.distance,
        ))
    }
}

#[pyclass(module = "palpate_servo")]
struct Proxy {
    body: Arc<surface::Body>,
    inner: Option<proxy::Proxy>,
}

type Held<'py> = (
    bool,
    Bound<'py, PyArray1<f64>>,
    i64,
    Bound<'py, PyArray1<f64>>,
);

impl Proxy {
    fn place<'py>(&self, py: Python<'py>) -> Held<'py> {
        let hold = self.inner.as_ref().and_then(proxy::Proxy::hold);
        let position = self.inner.as_ref().map_or(DVec3::ZERO, |p| p.position());
        (
            hold.is_some(),
            array(py, position),
            hold.map_or(-1, |h| i64::from(h.triangle)),
            PyArray1::from_slice(py, &hold.map_or([0.0; 3], |h| h.alpha)),
        )
    }
}

#[pymethods]
impl Proxy {
    #[new]
    fn new(body: &Body) -> Self {
        Self {
            body: body.inner.clone(),
            inner: None,
        }
    }

    fn restart(&mut self, position: Triple) -> PyResult<()> {
        let position = finite("position", position)?;
        self.inner = Some(proxy::Proxy::new(&self.body, position));
        Ok(())
    }

    #[pyo3(name = "move")]
    fn follow<'py>(&mut self, py: Python<'py>, device: Triple) -> PyResult<Held<'py>> {
        let device = finite("device", device)?;
        match &mut self.inner {
            Some(inner) => inner.follow(&self.body, device),
            None => self.inner = Some(proxy::Proxy::new(&self.body, device)),
        }
        Ok(self.place(py))
    }

    #[allow(clippy::type_complexity)] // A tuple is what Python gets.
    fn follow_path<'py>(
        &mut self,
        py: Python<'py>,
        devices: PyArrayLike2<'_, f64, AllowTypeChange>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<i64>>)> {
        let devices = devices.as_array();
        if devices.ncols() != 3 {
            return Err(PyValueError::new_err("devices must have three columns"));
        }
        let mut positions = Vec::with_capacity(devices.nrows());
        let mut triangles = Vec::with_capacity(devices.nrows());
        for row in devices.rows() {
            let device = finite("devices", [row[0], row[1], row[2]])?;
            let inner = match &mut self.inner {
                Some(inner) => {
                    inner.follow(&self.body, device);
                    inner
                }
                empty => empty.insert(proxy::Proxy::new(&self.body, device)),
            };
            positions.push(inner.position().to_array().to_vec());
            triangles.push(inner.hold().map_or(-1, |h| i64::from(h.triangle)));
        }
        Ok((
            PyArray2::from_vec2(py, &positions)?,
            PyArray1::from_vec(py, triangles),
        ))
    }

    #[getter]
    fn steps(&self) -> u32 {
        self.inner.as_ref().map_or(0, proxy::Proxy::steps)
    }

    #[getter]
    fn rescues(&self) -> u64 {
        self.inner.as_ref().map_or(0, proxy::Proxy::rescues)
    }
}

#[pyclass(frozen, module = "palpate_servo")]
struct Snapshot {
    inner: crate::servo::Snapshot,
}

#[pymethods]
impl Snapshot {
    #[getter]
    fn tick(&self) -> u64 {
        self.inner.tick
    }
    #[getter]
    fn time(&self) -> f64 {
        self.inner.time
    }
    #[getter]
    fn probe<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.inner.probe)
    }
    #[getter]
    fn proxy<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.inner.proxy)
    }
    #[getter]
    fn triangle<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let nodes = match self.inner.hold {
            Some(_) => self.inner.triangle.map(i64::from),
            None => [-1; 3],
        };
        PyArray1::from_slice(py, &nodes)
    }
    #[getter]
    fn triangle_index(&self) -> i64 {
        self.inner.hold.map_or(-1, |(t, _)| i64::from(t))
    }
    #[getter]
    fn alpha<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.inner.hold.map_or([0.0; 3], |(_, a)| a))
    }
    #[getter]
    fn nodal_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, &self.inner.nodal_forces)
    }
    #[getter]
    fn contact_force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.inner.contact_force)
    }
    #[getter]
    fn output_force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.inner.output_force)
    }
    #[getter]
    fn touching(&self) -> bool {
        self.inner.hold.is_some()
    }
    #[getter]
    fn state(&self) -> &'static str {
        self.inner.state.name()
    }
    #[getter]
    fn fault(&self) -> &'static str {
        self.inner.fault.map_or("", Fault::name)
    }
    #[getter]
    fn reason(&self) -> &'static str {
        self.inner.reason
    }
    #[getter]
    fn buttons(&self) -> u8 {
        self.inner.buttons
    }
    fn __repr__(&self) -> String {
        let s = &self.inner;
        format!(
            "Snapshot(tick={}, state={:?}, fault={:?}, probe={}, proxy={}, contact_force={})",
            s.tick,
            s.state.name(),
            self.fault(),
            s.probe,
            s.proxy,
            s.contact_force
        )
    }
}

#[pyclass(frozen, module = "palpate_servo")]
struct Servo {
    body: Arc<surface::Body>,
    options: Options,
    glide_speed: f64,
    record_samples: usize,
    settings: Mutex<Settings>,
    running: Mutex<Option<Arc<Running>>>,
    targets: Mutex<Option<(Input<Target>, u32)>>,
}

impl Servo {
    fn current(&self) -> Option<Arc<Running>> {
        locked(&self.running).clone()
    }

    fn published(&self) -> Published {
        self.current().map(|r| r.published()).unwrap_or_default()
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

    fn keep(&self, running: Running) {
        let running = Arc::new(running);
        let mut started = locked(&STARTED);
        started.retain(|weak| weak.strong_count() > 0);
        started.push(Arc::downgrade(&running));
        *locked(&self.running) = Some(running);
    }
}

#[pymethods]
impl Servo {
    #[new]
    #[pyo3(signature = (body, *, young_modulus, rate_hz=1000, max_force=3.0, max_slew=1000.0,
        ramp_seconds=0.25, max_speed=2.0, glide_speed=0.5, record_seconds=10.0))]
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
    ) -> PyResult<Self> {
        if !(100..=8000).contains(&rate_hz) {
            return Err(PyValueError::new_err(format!(
                "rate_hz is {rate_hz}; it must be from 100 to 8000"
            )));
        }
        for (name, value) in [
            ("ramp_seconds", ramp_seconds),
            ("record_seconds", record_seconds),
        ] {
            if !(0.0..=3600.0).contains(&value) {
                return Err(PyValueError::new_err(format!(
                    "{name} is {value}; it must be from 0 to 3600"
                )));
            }
        }
        Ok(Self {
            body: body.inner.clone(),
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
            settings: Mutex::new(Settings {
                young_modulus: positive("young_modulus", young_modulus)?,
                enabled: true,
                frame: DeviceFrame::default(),
            }),
            running: Mutex::new(None),
            targets: Mutex::new(None),
        })
    }

    fn start_pointer(&self, py: Python<'_>, position: Triple) -> PyResult<()> {
        self.refuse_if_running()?;
        let position = finite("position", position)?;
        let start = Target { position, epoch: 0 };
        let (input, output) = triple_buffer(&start);
        let pointer = Pointer::new(start, output, self.glide_speed);
        let settings = *locked(&self.settings);
        let running = py.detach(|| {
            Running::start(
                self.body.clone(),
                pointer,
                self.options,
                settings,
                self.record_samples,
            )
        })?;
        *locked(&self.targets) = Some((input, 0));
        self.keep(running);
        Ok(())
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
        let settings = {
            let mut settings = locked(&self.settings);
            settings.frame = frame;
            *settings
        };
        let running = py.detach(|| {
            let device = LinkDevice::open(SerialPort {
                path: port.clone(),
                baud,
            })
            .map_err(|e| PyOSError::new_err(format!("cannot open the port {port}: {e}")))?;
            Ok::<_, PyErr>(Running::start(
                self.body.clone(),
                device,
                self.options,
                settings,
                self.record_samples,
            )?)
        })?;
        *locked(&self.targets) = None;
        self.keep(running);
        Ok(())
    }

    #[pyo3(signature = (position, restart=false))]
    fn set_target(&self, position: Triple, restart: bool) -> PyResult<()> {
        let position = finite("position", position)?;
        match locked(&self.targets).as_mut() {
            Some((input, epoch)) => {
                *epoch = epoch.wrapping_add(u32::from(restart));
                input.write(Target {
                    position,
                    epoch: *epoch,
                });
                Ok(())
            }
            None => Err(PyRuntimeError::new_err(
                "targets lead a pointer; call start_pointer first",
            )),
        }
    }

    fn set_young_modulus(&self, young_modulus: f64) -> PyResult<()> {
        let young_modulus = positive("young_modulus", young_modulus)?;
        self.change(|s| s.young_modulus = young_modulus);
        Ok(())
    }

    fn set_device_frame(&self, rotation: Rows, translation: Triple, scale: f64) -> PyResult<()> {
        let frame = device_frame(rotation, translation, scale)?;
        self.change(|s| {
            s.frame = DeviceFrame {
                epoch: s.frame.epoch.wrapping_add(1),
                ..frame
            };
        });
        Ok(())
    }

    fn set_enabled(&self, enabled: bool) {
        self.change(|s| s.enabled = enabled);
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot {
            inner: self.published().snapshot,
        }
    }

    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let samples = self.current().map(|r| r.drain()).unwrap_or_default();
        let length = std::mem::size_of_val(samples.as_slice());
        // SAFETY: `Sample` is `repr(C)` of 8-byte numbers, without padding.
        let bytes = unsafe { std::slice::from_raw_parts(samples.as_ptr().cast::<u8>(), length) };
        let numpy = py.import("numpy")?;
        let dtype = numpy.call_method1("dtype", (sample_fields(py)?,))?;
        numpy.call_method1("frombuffer", (PyByteArray::new(py, bytes), dtype))
    }

    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let running = self.current();
        let counters = match &running {
            Some(running) => timing_counters(py, running.paced().timing(), running.paced())?,
            None => timing_counters_of(py, &Timing::default(), "not started")?,
        };
        let published = self.published();
        let faults = PyDict::new(py);
        for (fault, count) in Fault::ALL.iter().zip(published.faults) {
            faults.set_item(fault.name(), count)?;
        }
        counters.set_item("rate_hz", self.options.rate_hz)?;
        counters.set_item("faults", faults)?;
        counters.set_item("link", link_counters(py, &published.link)?)?;
        counters.set_item("samples_lost", published.samples_lost)?;
        let proxy = PyDict::new(py);
        proxy.set_item("most_steps", published.most_steps)?;
        proxy.set_item("rescues", published.rescues)?;
        counters.set_item("proxy", proxy)?;
        Ok(counters)
    }

    fn stop(&self, py: Python<'_>) {
        if let Some(running) = self.current() {
            py.detach(|| running.paced().stop());
        }
        *locked(&self.targets) = None;
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

fn device_frame(rotation: Rows, translation: Triple, scale: f64) -> PyResult<DeviceFrame> {
    let rotation = DMat3::from_cols_array_2d(&rotation).transpose();
    let error = rotation * rotation.transpose() - DMat3::IDENTITY;
    let is_orthonormal = error.to_cols_array().iter().all(|e| e.abs() < 1e-6);
    if !is_orthonormal {
        return Err(PyValueError::new_err(
            "rotation is not orthonormal; a device frame may turn and scale, not shear",
        ));
    }
    Ok(DeviceFrame {
        rotation,
        translation: finite("translation", translation)?,
        scale: positive("scale", scale)?,
        epoch: 0,
    })
}

fn sample_fields<'py>(py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
    const _: () = assert!(size_of::<Sample>() == 15 * 8);
    let number = |name: &str, kind: &str| (name, kind).into_pyobject(py).map(Bound::into_any);
    let vector = |name: &str| (name, "=f8", (3,)).into_pyobject(py).map(Bound::into_any);
    PyList::new(
        py,
        [
            number("tick", "=u8")?,
            number("time", "=f8")?,
            vector("probe")?,
            vector("proxy")?,
            vector("force")?,
            vector("output")?,
            number("state", "=u8")?,
        ],
    )
}

fn timing_counters<'py>(
    py: Python<'py>,
    timing: &Timing,
    paced: &Paced,
) -> PyResult<Bound<'py, PyDict>> {
    timing_counters_of(py, timing, paced.realtime())
}

fn timing_counters_of<'py>(
    py: Python<'py>,
    timing: &Timing,
    realtime: &str,
) -> PyResult<Bound<'py, PyDict>> {
    const LATE_TICK: usize = 2;
    let report = timing.report();
    let us = |ns: u64| ns as f64 * 1e-3;
    let counters = PyDict::new(py);
    counters.set_item("ticks", report.ticks)?;
    counters.set_item("missed", report.missed)?;
    counters.set_item("late_ticks", report.late[LATE_TICK])?;
    for (limit, count) in LATE_LIMITS_NS.iter().zip(report.late) {
        counters.set_item(format!("late_over_{}_us", limit / 1000), count)?;
    }
    let lateness = PyDict::new(py);
    for (name, part) in [("p50", 0.5), ("p99", 0.99), ("p99_9", 0.999)] {
        lateness.set_item(name, us(report.percentile_ns(part)))?;
    }
    lateness.set_item("max", us(report.worst_ns))?;
    counters.set_item("lateness_us", lateness)?;
    let filled = (0..BUCKETS).filter(|&i| report.histogram[i] > 0);
    let histogram: Vec<(f64, u64)> = filled
        .map(|i| (us(bucket_limit_ns(i)), report.histogram[i]))
        .collect();
    counters.set_item("histogram", histogram)?;
    counters.set_item("longest_gap_us", us(report.longest_gap_ns))?;
    let busy = PyDict::new(py);
    busy.set_item("mean", us(report.busy_ns) / report.ticks.max(1) as f64)?;
    busy.set_item("max", us(report.busiest_ns))?;
    counters.set_item("busy_us", busy)?;
    counters.set_item("realtime", realtime)?;
    Ok(counters)
}

fn link_counters<'py>(py: Python<'py>, link: &LinkReport) -> PyResult<Bound<'py, PyDict>> {
    let counters = PyDict::new(py);
    for (name, count) in [
        ("states", link.states),
        ("forces", link.forces),
        ("lost", link.lost),
        ("duplicates", link.duplicates),
        ("out_of_order", link.out_of_order),
        ("crc_errors", link.crc_errors),
        ("cobs_errors", link.cobs_errors),
        ("oversize", link.oversize),
        ("unknown", link.unknown),
        ("hellos", link.hellos),
        ("device_faults", link.device_faults),
        ("unsent", link.unsent),
        ("reopened", link.reopened),
    ] {
        counters.set_item(name, count)?;
    }
    counters.set_item("last_fault", link.last_fault)?;
    let device = link.greeting.map(|g| -> PyResult<_> {
        let device = PyDict::new(py);
        let name = String::from_utf8_lossy(&g.name);
        device.set_item("name", name.trim_end_matches('\0'))?;
        device.set_item("protocol", g.protocol)?;
        device.set_item("axes", g.axes)?;
        device.set_item("max_force", g.max_force)?;
        device.set_item("half_extents", g.half_extents)?;
        device.set_item("rate_hz", g.rate_hz)?;
        Ok(device)
    });
    counters.set_item("device", device.transpose()?)?;
    Ok(counters)
}

#[pyclass(frozen, module = "palpate_servo")]
struct BareTimer {
    paced: Paced,
}

#[pymethods]
impl BareTimer {
    #[new]
    #[pyo3(signature = (rate_hz=1000))]
    fn new(rate_hz: u32) -> PyResult<Self> {
        if !(100..=8000).contains(&rate_hz) {
            return Err(PyValueError::new_err(format!(
                "rate_hz is {rate_hz}; it must be from 100 to 8000"
            )));
        }
        Ok(Self {
            paced: Paced::bare(rate_hz)?,
        })
    }

    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        timing_counters(py, self.paced.timing(), &self.paced)
    }

    fn stop<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        py.detach(|| self.paced.stop());
        self.counters(py)
    }
}

#[pyfunction]
fn bare_timer<'py>(py: Python<'py>, rate_hz: u32, seconds: f64) -> PyResult<Bound<'py, PyDict>> {
    if !(0.0..=3600.0).contains(&seconds) {
        return Err(PyValueError::new_err(format!(
            "seconds is {seconds}; it must be from 0 to 3600"
        )));
    }
    let timer = BareTimer::new(rate_hz)?;
    py.detach(|| std::thread::sleep(std::time::Duration::from_secs_f64(seconds)));
    timer.stop(py)
}

#[pyfunction]
fn encode_frame<'py>(py: Python<'py>, payload: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
    let mut frame = [0; codec::MAX_FRAME];
    let length = codec::encode(payload, &mut frame).ok_or_else(|| {
        PyValueError::new_err(format!(
            "a payload of {} bytes does not fit a frame; 1 to {} do",
            payload.len(),
            codec::MAX_PAYLOAD
        ))
    })?;
    Ok(PyBytes::new(py, &frame[..length]))
}

#[pyclass(module = "palpate_servo")]
struct Decoder {
    inner: codec::Decoder,
}

#[pymethods]
impl Decoder {
    #[new]
    fn new() -> Self {
        Self {
            inner: codec::Decoder::default(),
        }
    }

    fn feed<'py>(&mut self, py: Python<'py>, data: &[u8]) -> Vec<Bound<'py, PyBytes>> {
        data.iter()
            .filter_map(|&byte| self.inner.push(byte).map(|p| PyBytes::new(py, p)))
            .collect()
    }

    #[getter]
    fn crc_errors(&self) -> u64 {
        self.inner.errors.crc
    }

    #[getter]
    fn cobs_errors(&self) -> u64 {
        self.inner.errors.cobs
    }

    #[getter]
    fn oversize(&self) -> u64 {
        self.inner.errors.oversize
    }
}

/// Stops every servo that still runs; called at the interpreter's exit.
#[pyfunction]
fn stop_all(py: Python<'_>) {
    let started = std::mem::take(&mut *locked(&STARTED));
    py.detach(|| {
        for running in started.iter().filter_map(Weak::upgrade) {
            running.paced().stop();
        }
    });
}

#[pymodule]
fn palpate_servo(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add_class::<Body>()?;
    module.add_class::<Proxy>()?;
    module.add_class::<Servo>()?;
    module.add_class::<Snapshot>()?;
    module.add_class::<BareTimer>()?;
    module.add_class::<Decoder>()?;
    module.add_function(wrap_pyfunction!(bare_timer, module)?)?;
    module.add_function(wrap_pyfunction!(encode_frame, module)?)?;
    let stop = wrap_pyfunction!(stop_all, module)?;
    py.import("atexit")?.call_method1("register", (&stop,))?;
    module.add_function(stop)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    let states: Vec<&str> = (0..=State::Stopped as u8)
        .map(|n| STATES[n as usize].name())
        .collect();
    module.add("STATES", pyo3::types::PyTuple::new(py, states)?)?;
    Ok(())
}

const STATES: [State; 6] = [
    State::Waiting,
    State::Free,
    State::Touching,
    State::Fault,
    State::Disabled,
    State::Stopped,
];
