//! `SteppedServo`: the servo's own ticks over the link's own bytes, in a time that the caller makes.

use std::io::{self, ErrorKind};
use std::sync::{Arc, Mutex, MutexGuard};

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::device::Device;
use crate::device::haply::device::HaplyDevice;
use crate::device::link::LinkDevice;
use crate::device::serial::wire::{Opener, Wire};
use crate::python::body::surface::Body;
use crate::python::device::haply::haply_setup;
use crate::python::harness::stepping::Stepping;
use crate::python::servo::counters::{fault_counters, link_counters};
use crate::python::servo::settings::{Chosen, Given, options};
use crate::python::servo::snapshot::Snapshot;
use crate::python::servo::told::Loads;
use crate::servo::paced::locked;
use crate::servo::settings::Settings;

/// What a driver keeps of what its line has not taken yet, bytes.
const DRIVER_BYTES: usize = 4096;

/// Bytes on the line in either direction.
#[derive(Debug, Default)]
struct Line {
    to_host: Vec<u8>,
    from_host: Vec<u8>,
    is_unplugged: bool,
}

/// A line in memory.
#[derive(Clone, Default)]
struct InMemory(Arc<Mutex<Line>>);

impl InMemory {
    fn line(&self) -> MutexGuard<'_, Line> {
        locked(&self.0)
    }
}

impl Wire for InMemory {
    fn waiting(&mut self) -> io::Result<usize> {
        let line = self.line();
        match line.is_unplugged {
            true => Err(ErrorKind::NotConnected.into()),
            false => Ok(line.to_host.len()),
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut line = self.line();
        let length = buffer.len().min(line.to_host.len());
        buffer[..length].copy_from_slice(&line.to_host[..length]);
        line.to_host.drain(..length);
        Ok(length)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut line = self.line();
        let room = DRIVER_BYTES.saturating_sub(line.from_host.len());
        if room == 0 {
            return Err(ErrorKind::WouldBlock.into());
        }
        let length = room.min(bytes.len());
        line.from_host.extend(&bytes[..length]);
        Ok(length)
    }

    fn queued(&mut self) -> usize {
        self.line().from_host.len()
    }

    fn discard(&mut self) {
        self.line().from_host.clear();
    }
}

impl Opener for InMemory {
    type Wire = Self;

    fn open(&mut self) -> io::Result<Self> {
        if self.line().is_unplugged {
            Err(ErrorKind::NotFound.into())
        } else {
            Ok(self.clone())
        }
    }
}

/// The ticks of a Servo, by hand and in virtual time, with a device on a line in memory.
///
/// Nothing waits, and the same input gives the same output. Methods are as of Servo; `tick(received,
/// seconds, taken)` ticks `seconds` (default: a period) after the last time and returns what is sent, at
/// most `taken` bytes of it (default: all): the rest waits in the driver, which has room for 4096. The
/// device speaks the link, or is the Haply 2DIY of a model, its handle at rest when it is first heard.
#[pyclass(frozen, module = "palpate_servo.harness")]
pub struct SteppedServo {
    wire: InMemory,
    stepped: Mutex<Stepping>,
}

#[pymethods]
impl SteppedServo {
    #[new]
    #[pyo3(signature = (body, settings, *, rate_hz=1000, max_force=3.0, max_slew=1000.0,
        ramp_seconds=0.25, max_speed=2.0, haply=None))]
    #[allow(clippy::too_many_arguments)] // Keywords in Python.
    fn new(
        body: &Body,
        settings: Given,
        rate_hz: u32,
        max_force: f64,
        max_slew: f64,
        ramp_seconds: f64,
        max_speed: f64,
        haply: Option<&str>,
    ) -> PyResult<Self> {
        let options = options(rate_hz, max_force, max_slew, ramp_seconds, max_speed)?;
        let wire = InMemory::default();
        let device: Box<dyn Device> = match haply {
            None => Box::new(LinkDevice::open(wire.clone())?),
            Some(model) => {
                let (model, calibration) = haply_setup(model, None, true, None)?;
                Box::new(HaplyDevice::open(wire.clone(), model, calibration)?)
            }
        };
        let stepped = Mutex::new(Stepping::new(body, vec![device], &settings, options)?);
        Ok(Self { wire, stepped })
    }

    #[pyo3(signature = (received=None, seconds=None, taken=None))]
    fn tick<'py>(
        &self,
        py: Python<'py>,
        received: Option<&[u8]>,
        seconds: Option<f64>,
        taken: Option<usize>,
    ) -> Bound<'py, PyBytes> {
        self.wire.line().to_host.extend(received.unwrap_or(&[]));
        locked(&self.stepped).tick(seconds);
        let waiting = &mut self.wire.line().from_host;
        let most = taken.unwrap_or(usize::MAX).min(waiting.len());
        let sent: Vec<u8> = waiting.drain(..most).collect();
        PyBytes::new(py, &sent)
    }

    fn unplug(&self) {
        *self.wire.line() = Line {
            is_unplugged: true,
            ..Line::default()
        };
    }

    fn plug_in(&self) {
        self.wire.line().is_unplugged = false;
    }

    fn set(&self, settings: Given) -> PyResult<()> {
        let chosen = Chosen::with_any_modulus(&settings)?;
        let mut stepped = locked(&self.stepped);
        let settings = chosen.on(&Settings::new(1.0).fingers, &stepped.settings);
        stepped.write(settings);
        Ok(())
    }

    fn set_body(&self, body: &Body, settings: Given) -> PyResult<()> {
        locked(&self.stepped).ends.bodies.give(body.inner.clone());
        self.set(settings)?;
        locked(&self.stepped).ends.bodies.settle();
        Ok(())
    }

    fn snapshot(&self, py: Python<'_>) -> PyResult<Py<Snapshot>> {
        Snapshot::of(
            py,
            locked(&self.stepped).ends.snapshots.read(),
            &[],
            Loads::default(),
        )
    }

    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let told = *locked(&self.stepped).ends.snapshots.read().first();
        let counters = PyDict::new(py);
        counters.set_item("faults", fault_counters(py, &told)?)?;
        counters.set_item("link", link_counters(py, &told.link)?)?;
        Ok(counters)
    }
}
