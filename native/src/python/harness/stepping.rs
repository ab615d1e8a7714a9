//! A servo whose ticks are made by hand, in a time of their own.

use pyo3::prelude::*;

use crate::device::Device;
use crate::python::body::surface::Body;
use crate::python::servo::settings::{Chosen, Given};
use crate::servo::Servo;
use crate::servo::exchange::ends::Ends;
use crate::servo::settings::{Options, Settings};

/// A servo with all its ends, and the time of its last tick, s.
pub struct Stepping {
    pub servo: Servo,
    pub ends: Ends,
    pub settings: Settings,
    period: f64,
    now: f64,
}

impl Stepping {
    pub fn new(
        body: &Body,
        devices: Vec<Box<dyn Device>>,
        settings: &Given,
        options: Options,
    ) -> PyResult<Self> {
        let plain = Settings::new(1.0);
        let settings = Chosen::checked(settings)?.on(&plain.fingers, &plain);
        let (servo, ends) = Servo::new(body.inner.clone(), devices, options, &settings, 1);
        Ok(Self {
            servo,
            ends,
            settings,
            period: 1.0 / f64::from(options.rate_hz),
            now: 0.0,
        })
    }

    /// A tick, `seconds` or a period after the last one.
    pub fn tick(&mut self, seconds: Option<f64>) {
        self.now += seconds.unwrap_or(self.period);
        self.servo.tick(self.now);
    }

    /// Sets what was chosen.
    pub fn write(&mut self, settings: Settings) {
        self.settings = settings;
        self.ends.settings.write(settings);
    }
}
