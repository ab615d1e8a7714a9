//! `Proxy`: god object and contact point alone.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use numpy::{AllowTypeChange, PyArray1, PyArrayLike2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::body::surface;
use crate::contact::touch::touch;
use crate::proxy;
use crate::proxy::Feel;
use crate::python::body::surface::Body;
use crate::python::servo::settings::{contact_mode, feel};
use crate::python::vectors::{Matrix, Triple, Vector, array, check_rate, finite, table, vectors};

/// God object and contact point alone, by the same code as in the servo.
///
/// `move(device)` tells: touching, contact point (3,), triangle (-1 if free), alpha (3,); `follow_path`
/// contact points (k, 3) and triangles (k,) for devices (k, 3); `time_path` seconds a tick, averaged
/// over batches. ValueError unless 0 <= dynamic_friction <= static_friction.
#[pyclass(module = "palpate_servo.harness")]
pub struct Proxy {
    body: Arc<surface::Body>,
    inner: Option<proxy::Proxy>,
    feel: proxy::Feel,
    dt: f64,
}

type Held<'py> = (bool, Vector<'py>, i64, Vector<'py>);

impl Proxy {
    /// After a tick; set down by the first one.
    fn led(&mut self, device: DVec3) -> &proxy::Proxy {
        match &mut self.inner {
            Some(inner) => {
                inner.follow(&self.body, device, &self.feel, self.dt);
                inner
            }
            empty => empty.insert(proxy::Proxy::new(&self.body, device)),
        }
    }
}

#[pymethods]
impl Proxy {
    #[new]
    #[pyo3(signature = (body, *, shading=false, static_friction=0.0, dynamic_friction=0.0,
        rate_hz=1000, mode="consistent"))]
    fn new(
        body: &Body,
        shading: bool,
        static_friction: f64,
        dynamic_friction: f64,
        rate_hz: u32,
        mode: &str,
    ) -> PyResult<Self> {
        check_rate(rate_hz)?;
        Ok(Self {
            body: body.inner.clone(),
            inner: None,
            feel: Feel {
                mode: contact_mode(mode)?,
                ..feel(shading, static_friction, dynamic_friction)?
            },
            dt: 1.0 / f64::from(rate_hz),
        })
    }

    fn restart(&mut self, position: Triple) -> PyResult<()> {
        let position = finite("position", position)?;
        self.inner = Some(proxy::Proxy::new(&self.body, position));
        Ok(())
    }

    #[pyo3(name = "move")]
    fn follow<'py>(&mut self, py: Python<'py>, device: Triple) -> PyResult<Held<'py>> {
        let device = finite("device", device)?;
        let inner = self.led(device);
        let hold = inner.hold();
        Ok((
            hold.is_some(),
            array(py, inner.position()),
            hold.map_or(-1, |h| i64::from(h.triangle)),
            PyArray1::from_slice(py, &hold.map_or([0.0; 3], |h| h.alpha)),
        ))
    }

    fn follow_path<'py>(
        &mut self,
        py: Python<'py>,
        devices: PyArrayLike2<'_, f64, AllowTypeChange>,
    ) -> PyResult<(Matrix<'py>, Bound<'py, PyArray1<i64>>)> {
        let devices = vectors("devices", &devices)?;
        let mut triangles = Vec::with_capacity(devices.len());
        let positions = devices.into_iter().map(|device| {
            let inner = self.led(device);
            triangles.push(inner.hold().map_or(-1, |h| i64::from(h.triangle)));
            inner.position()
        });
        let positions = table(py, positions)?;
        Ok((positions, PyArray1::from_vec(py, triangles)))
    }

    fn time_path<'py>(
        &mut self,
        py: Python<'py>,
        devices: PyArrayLike2<'_, f64, AllowTypeChange>,
        batch: usize,
    ) -> PyResult<Vector<'py>> {
        if batch == 0 {
            return Err(PyValueError::new_err("batch must be at least 1"));
        }
        let devices = vectors("devices", &devices)?;
        let (body, feel, dt) = (&*self.body, self.feel, self.dt);
        let first = devices.first().copied().unwrap_or(DVec3::ZERO);
        let inner = (self.inner).get_or_insert_with(|| proxy::Proxy::new(body, first));
        let seconds: Vec<f64> = devices
            .chunks(batch)
            .map(|batch| {
                let start = Instant::now();
                for &device in batch {
                    inner.follow(body, black_box(device), &feel, dt);
                    if let Some(hold) = inner.hold() {
                        let displacement = device - inner.position();
                        black_box(touch(
                            body,
                            feel.mode,
                            hold.triangle,
                            hold.alpha,
                            displacement,
                            1e3,
                        ));
                    }
                }
                start.elapsed().as_secs_f64() / batch.len() as f64
            })
            .collect();
        Ok(PyArray1::from_vec(py, seconds))
    }

    #[getter]
    fn sticking(&self) -> bool {
        self.inner.as_ref().is_some_and(proxy::Proxy::is_sticking)
    }
}
