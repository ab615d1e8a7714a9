//! `Pointer`, `LinkDevice`, `HaplyDevice`: what moves a finger, described before it is opened.

use glam::DVec3;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use triple_buffer::{Input, triple_buffer};

use crate::device::haply::device::{Calibration, HaplyDevice};
use crate::device::haply::model::Model;
use crate::device::link::LinkDevice;
use crate::device::pointer::{Pointer, Target};
use crate::device::serial::guarded::GuardedPort;
use crate::device::serial::port::SerialPort;
use crate::device::serial::reopening::Reopening;
use crate::device::{Device, DeviceFrame};
use crate::python::device::haply::haply_setup;
use crate::python::servo::settings::device_frame;
use crate::python::vectors::{IDENTITY, Rows, Triple, finite};

#[pyclass(frozen, name = "Pointer", module = "palpate_servo")]
pub struct PointerSetup {
    position: DVec3,
}

#[pymethods]
impl PointerSetup {
    #[new]
    fn new(position: Triple) -> PyResult<Self> {
        let position = finite("position", position)?;
        Ok(Self { position })
    }
}

/// Speeds at which a line can carry anything, bits a second.
const BAUDS: std::ops::RangeInclusive<u32> = 300..=12_000_000;

fn check_baud(baud: Option<u32>) -> PyResult<()> {
    match baud {
        Some(baud) if !BAUDS.contains(&baud) => Err(PyValueError::new_err(format!(
            "baud is {baud}; it must be from {} to {}, or None for a port whose speed has no meaning",
            BAUDS.start(),
            BAUDS.end()
        ))),
        _ => Ok(()),
    }
}

fn guarded(path: String, baud: Option<u32>, needs_guardian: bool) -> GuardedPort {
    let port = SerialPort { path, baud };
    GuardedPort {
        port,
        needs_guardian,
    }
}

#[pyclass(frozen, name = "LinkDevice", module = "palpate_servo")]
pub struct LinkSetup {
    port: GuardedPort,
    frame: DeviceFrame,
}

#[pymethods]
impl LinkSetup {
    #[new]
    #[pyo3(signature = (port, *, baud=None, rotation=IDENTITY, translation=[0.0; 3], scale=1.0))]
    fn new(
        port: String,
        baud: Option<u32>,
        rotation: Rows,
        translation: Triple,
        scale: f64,
    ) -> PyResult<Self> {
        check_baud(baud)?;
        Ok(Self {
            port: guarded(port, baud, false),
            frame: device_frame(rotation, translation, scale)?,
        })
    }
}

#[pyclass(frozen, name = "HaplyDevice", module = "palpate_servo")]
pub struct HaplySetup {
    port: GuardedPort,
    frame: DeviceFrame,
    model: &'static Model,
    calibration: Calibration,
}

#[pymethods]
impl HaplySetup {
    #[new]
    #[pyo3(signature = (
        port, *, model="2diy-3.1", angles=None, recalibrate=false, baud=None,
        rotation=IDENTITY, translation=[0.0; 3], scale=1.0
    ))]
    #[allow(clippy::too_many_arguments)] // Keywords in Python.
    fn new(
        port: String,
        model: &str,
        angles: Option<[f32; 2]>,
        recalibrate: bool,
        baud: Option<u32>,
        rotation: Rows,
        translation: Triple,
        scale: f64,
    ) -> PyResult<Self> {
        check_baud(baud)?;
        let (model, calibration) = haply_setup(model, angles, recalibrate, baud)?;
        Ok(Self {
            port: guarded(port, baud, true),
            frame: device_frame(rotation, translation, scale)?,
            model,
            calibration,
        })
    }
}

/// Any of them.
#[derive(FromPyObject)]
pub enum DeviceSetup<'py> {
    Pointer(PyRef<'py, PointerSetup>),
    Link(PyRef<'py, LinkSetup>),
    Haply(PyRef<'py, HaplySetup>),
}

/// Target of a pointer, and the last one.
pub type Lead = (Input<Target>, Target);

/// A device that can be read.
pub struct Opened {
    pub device: Box<dyn Device>,
    /// Lead of a pointer.
    pub lead: Option<Lead>,
    /// Mount of a device with motors: where it is in the body, and the step of its encoders, m.
    pub mount: Option<(DeviceFrame, f64)>,
}

impl DeviceSetup<'_> {
    pub fn open(&self, py: Python<'_>, glide_speed: f64) -> PyResult<Opened> {
        match self {
            Self::Pointer(setup) => {
                let start = Target::first(setup.position);
                let (input, output) = triple_buffer(&start);
                Ok(Opened {
                    device: Box::new(Pointer::new(start, output, glide_speed)),
                    lead: Some((input, start)),
                    mount: None,
                })
            }
            Self::Link(setup) => Ok(Opened {
                device: opened(py, &setup.port, LinkDevice::open)?,
                lead: None,
                mount: Some((setup.frame, 0.0)),
            }),
            Self::Haply(setup) => {
                let (model, calibration) = (setup.model, setup.calibration);
                let open = move |port| HaplyDevice::open(port, model, calibration);
                Ok(Opened {
                    device: opened(py, &setup.port, open)?,
                    lead: None,
                    mount: Some((setup.frame, model.encoder_step())),
                })
            }
        }
    }
}

fn opened<D: Device + 'static>(
    py: Python<'_>,
    port: &GuardedPort,
    open: impl FnOnce(Reopening) -> std::io::Result<D> + Send,
) -> PyResult<Box<dyn Device>> {
    let opener = || Reopening::of(port.clone()).and_then(open);
    let device = py.detach(opener).map_err(|e| {
        PyOSError::new_err(format!(
            "{}: cannot be opened ({e}); close the program that uses it, or see 'palpate devices'",
            port.port.path
        ))
    })?;
    Ok(Box::new(device))
}
