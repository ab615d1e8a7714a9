//! Settings of a servo, from the names and numbers that Python gives.

use std::ops::RangeInclusive;

use glam::DMat3;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::contact::cones::MAX_FINGERS;
use crate::contact::touch::ContactMode;
use crate::control::coupling::Coupling;
use crate::control::firmness::{Firmness, MOST_KNOTS};
use crate::control::safety::Limits;
use crate::creep::relaxation::Creep;
use crate::creep::term::{MOST_TERMS, Term};
use crate::device::DeviceFrame;
use crate::proxy::Feel;
use crate::python::vectors::{
    Rows, Triple, check_rate, check_seconds, finite, is_orthonormal, matrix, positive, rotation,
};
use crate::servo::settings::FingerSettings;
use crate::servo::settings::{Options, Settings};

/// Shortest and longest ramp, s. A force that comes back must be felt coming: a hand's first reflexes
/// take 20 to 50 ms.
const RAMPS: RangeInclusive<f64> = 0.05..=3600.0;

/// What stays as it is while a servo runs.
pub fn options(
    rate_hz: u32,
    max_force: f64,
    max_slew: f64,
    ramp_seconds: f64,
    max_speed: f64,
) -> PyResult<Options> {
    check_rate(rate_hz)?;
    check_seconds("ramp_seconds", ramp_seconds, RAMPS)?;
    Ok(Options {
        rate_hz,
        limits: Limits {
            max_force: positive("max_force", max_force)?,
            max_slew: positive("max_slew", max_slew)?,
            ramp_seconds,
        },
        max_speed: positive("max_speed", max_speed)?,
    })
}

pub fn contact_mode(name: &str) -> PyResult<ContactMode> {
    let found = ContactMode::ALL
        .into_iter()
        .find(|mode| mode.name() == name);
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "mode is {name:?}; it must be \"paper\" or \"consistent\""
        ))
    })
}

/// From shares of the modulus in the end, and times in s.
fn creep(relaxation: &[(f64, f64)]) -> PyResult<Creep> {
    let term = |&(share, seconds): &(f64, f64)| Term { share, seconds };
    let terms: Vec<Term> = relaxation.iter().map(term).collect();
    Creep::of(&terms).ok_or_else(|| {
        PyValueError::new_err(format!(
            "relaxation is {relaxation:?}; give at most {MOST_TERMS} pairs of a share, zero or more, \
             and a time in seconds, each another one"
        ))
    })
}

/// Settings as Python gives them: any object with these attributes, `core/servo/settings.py` has one.
#[derive(FromPyObject)]
pub struct Given {
    young_modulus: f64,
    enabled: bool,
    max_force: Option<f64>,
    shading: bool,
    static_friction: f64,
    dynamic_friction: f64,
    mode: String,
    relaxation: Vec<(f64, f64)>,
    coupling: Option<GivenCoupling>,
    frames: Vec<Option<GivenFrame>>,
    orientations: Vec<Rows>,
}

#[derive(FromPyObject)]
pub struct GivenCoupling {
    stiffness: f64,
    damping: f64,
    passivity_control: bool,
}

impl GivenCoupling {
    /// One that can be.
    ///
    /// # Errors
    /// ValueError for numbers without sense.
    pub fn checked(&self) -> PyResult<Coupling> {
        if self.stiffness.is_nan() || self.stiffness <= 0.0 {
            return Err(PyValueError::new_err(format!(
                "stiffness is {}; it must be more than 0 N/m, infinite for the body's own",
                self.stiffness
            )));
        }
        if !self.damping.is_finite() || self.damping < 0.0 {
            return Err(PyValueError::new_err(format!(
                "damping is {}; it must be finite and at least 0 N s/m",
                self.damping
            )));
        }
        Ok(Coupling {
            stiffness: self.stiffness,
            damping: self.damping,
            passivity_control: self.passivity_control,
        })
    }
}

#[derive(FromPyObject)]
struct GivenFrame {
    rotation: Rows,
    translation: Triple,
    scale: f64,
}

/// Settings that can be; what a device brings with it stands where nothing was given.
#[derive(Debug, Clone, Copy)]
pub struct Chosen {
    settings: Settings,
    coupling: Option<Coupling>,
    frames: [Option<DeviceFrame>; MAX_FINGERS],
}

impl Chosen {
    /// Checks settings.
    ///
    /// # Errors
    /// ValueError for one that cannot be.
    pub fn checked(given: &Given) -> PyResult<Self> {
        let modulus = positive("young_modulus", given.young_modulus)?;
        Self::with_modulus(given, modulus)
    }

    /// The same with a modulus that may be none, to see what comes of it.
    ///
    /// # Errors
    /// As [`Self::checked`], but for the modulus.
    #[cfg(feature = "harness")]
    pub fn with_any_modulus(given: &Given) -> PyResult<Self> {
        Self::with_modulus(given, given.young_modulus)
    }

    fn with_modulus(given: &Given, young_modulus: f64) -> PyResult<Self> {
        let most = given.frames.len().max(given.orientations.len());
        if most > MAX_FINGERS {
            return Err(PyValueError::new_err(format!(
                "settings are of {most} fingers; a servo has fingers 0 to {}",
                MAX_FINGERS - 1
            )));
        }
        let mut settings = Settings {
            enabled: given.enabled,
            max_force: (given.max_force)
                .map(|force| positive("max_force", force))
                .transpose()?,
            creep: creep(&given.relaxation)?,
            feel: Feel {
                mode: contact_mode(&given.mode)?,
                ..feel(given.shading, given.static_friction, given.dynamic_friction)?
            },
            ..Settings::new(young_modulus)
        };
        let mut frames = [None; MAX_FINGERS];
        for (frame, given) in frames.iter_mut().zip(&given.frames) {
            *frame = (given.as_ref())
                .map(|f| device_frame(f.rotation, f.translation, f.scale))
                .transpose()?;
        }
        for (finger, &given) in settings.fingers.iter_mut().zip(&given.orientations) {
            finger.orientation = rotation("orientation", given)?;
        }
        Ok(Self {
            settings,
            coupling: (given.coupling.as_ref())
                .map(GivenCoupling::checked)
                .transpose()?,
            frames,
        })
    }

    /// These settings for devices that bring couplings and frames, after others: a frame that is
    /// another one than before sets the probe down anew.
    pub fn on(&self, brought: &[FingerSettings; MAX_FINGERS], before: &Settings) -> Settings {
        let mut settings = Settings {
            firmness: before.firmness,
            ..self.settings
        };
        for (k, finger) in settings.fingers.iter_mut().enumerate() {
            let orientation = finger.orientation;
            *finger = FingerSettings {
                frame: before.fingers[k].frame,
                coupling: self.coupling.unwrap_or(brought[k].coupling),
                orientation,
            };
            let frame = self.frames[k].unwrap_or(brought[k].frame);
            if !frame.maps_as(&finger.frame) {
                finger.move_device(frame);
            }
        }
        settings
    }
}

/// How firm the body is, from its firmness at energies, J/Pa.
pub fn firmness(energies: &[f64], shares: &[f64]) -> PyResult<Firmness> {
    let known: Vec<_> = energies
        .iter()
        .copied()
        .zip(shares.iter().copied())
        .collect();
    let told = Firmness::through(&known).filter(|_| energies.len() == shares.len());
    told.ok_or_else(|| {
        PyValueError::new_err(format!(
            "firmness is {shares:?} at {energies:?}; give as many finite numbers as energies, which are above zero \
             and ascend, {MOST_KNOTS} at most"
        ))
    })
}

/// The surface, felt in the default mode.
pub fn feel(shading: bool, static_friction: f64, dynamic_friction: f64) -> PyResult<Feel> {
    let are_coefficients = static_friction.is_finite() && dynamic_friction >= 0.0;
    if !are_coefficients || dynamic_friction > static_friction {
        return Err(PyValueError::new_err(format!(
            "static_friction is {static_friction} and dynamic_friction {dynamic_friction}; they must be \
             finite, 0 <= dynamic_friction <= static_friction"
        )));
    }
    Ok(Feel {
        shading,
        static_friction,
        dynamic_friction,
        mode: ContactMode::default(),
    })
}

/// May mirror: a device's axes may be left-handed.
pub fn device_frame(rotation: Rows, translation: Triple, scale: f64) -> PyResult<DeviceFrame> {
    let turn: DMat3 = matrix(rotation);
    if !is_orthonormal(&turn) {
        return Err(PyValueError::new_err(format!(
            "rotation is {rotation:?}, not orthonormal; a device frame may turn and scale, not shear"
        )));
    }
    Ok(DeviceFrame {
        rotation: turn,
        translation: finite("translation", translation)?,
        scale: positive("scale", scale)?,
        epoch: 0,
    })
}
