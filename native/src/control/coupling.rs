//! The virtual coupling: it keeps a stiff body, a delay and a motor from making energy together.
//!
//! Between the body's force (14) and the safety limits lies a spring with a damper (a virtual
//! coupling: Colgate, Stanley and Brown 1995) and an observer of energy ([`Passivity`]). Both
//! are for devices with motors; a pointer feels the body itself.

use glam::{DMat3, DVec3};

use crate::algebra::series_share;
use crate::control::passivity::{LAG_SECONDS, Passivity};

/// Coupling of the body to a device with motors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// The most the device may see of any body's stiffness, N/m; infinite for the body as it is.
    pub stiffness: f64,
    /// Damping that goes with that stiffness, N s/m. A softer body has its share, so that the time
    /// `damping / stiffness` is the same for all; with infinite stiffness there is none.
    pub damping: f64,
    /// Whether energy that would come out of the contact is taken back (time-domain passivity).
    pub passivity_control: bool,
}

impl Default for Coupling {
    fn default() -> Self {
        Self {
            stiffness: f64::INFINITY,
            damping: 0.0,
            passivity_control: false,
        }
    }
}

impl Coupling {
    /// The coupling for devices with motors that nothing is known of, at `rate_hz` ticks a second.
    ///
    /// Passive for all plants and hands of the range in `docs/stability.md`.
    pub fn for_devices(rate_hz: u32) -> Self {
        // Holding a force for longer than a millisecond is one more delay.
        let slowness = (LAG_SECONDS + 0.5 / f64::from(rate_hz)) / (LAG_SECONDS + 0.5e-3);
        let stiffness = MOST_STIFFNESS / slowness.max(1.0).powi(2);
        Self {
            stiffness,
            damping: stiffness * LEAD_SECONDS * slowness.max(1.0),
            passivity_control: true,
        }
    }

    /// The coupling for devices with motors whose encoders have steps of `encoder_step` metres at the
    /// handle; fine ones are no matter.
    ///
    /// Passive for the range of coarse encoders in `docs/stability.md`.
    pub fn for_encoders(rate_hz: u32, encoder_step: f64) -> Self {
        let usual = Self::for_devices(rate_hz);
        if encoder_step <= FINE_STEP {
            return usual;
        }
        let stiffness = usual.stiffness.min(FORCE_OF_A_STEP / encoder_step);
        Self {
            stiffness,
            damping: stiffness * usual.lead_seconds(),
            // It takes each step for a motion, and would brake, that is push, for nothing.
            passivity_control: false,
        }
    }

    /// Seconds by which the damping makes the force lead.
    pub fn lead_seconds(&self) -> f64 {
        self.damping / self.stiffness
    }
}

/// Stiffness of [`Coupling::for_devices`], N/m.
const MOST_STIFFNESS: f64 = 800.0;
/// Its damping over its stiffness, s.
const LEAD_SECONDS: f64 = 5.0e-3;
/// Up to this step of the encoders, m, [`Coupling::for_devices`] is passive.
const FINE_STEP: f64 = 60.0e-6;
/// Change of the spring's force with a step of coarser encoders, N: Coulomb friction has to swallow
/// half of it (Diolaiti, Niemeyer, Barbagli and Salisbury 2006), and the damping's part too.
const FORCE_OF_A_STEP: f64 = 0.06;
/// Smoothing of the velocity, s: steps of an encoder come as single jumps.
const SMOOTHING_SECONDS: f64 = 1.0e-3;
/// Added force over the spring's own, at most.
const MOST_GAIN: f64 = 2.0;

/// Largest eigenvalue of a symmetric matrix (Smith 1961).
pub(crate) fn largest_eigenvalue(matrix: &DMat3) -> f64 {
    let mean = (matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z) / 3.0;
    let rest = *matrix - DMat3::from_diagonal(DVec3::splat(mean));
    let squares =
        rest.x_axis.length_squared() + rest.y_axis.length_squared() + rest.z_axis.length_squared();
    let spread = (squares / 6.0).sqrt();
    if spread <= f64::EPSILON * mean.abs() {
        return mean;
    }
    let angle = ((rest * (1.0 / spread)).determinant() * 0.5)
        .clamp(-1.0, 1.0)
        .acos();
    mean + 2.0 * spread * (angle / 3.0).cos()
}

/// Compliance (m/N) of the spring in series with the touched place: as much as keeps the whole from
/// being stiffer than `most` N/m in any direction, none if it is not.
pub fn series_compliance(stiffness: &DMat3, most: f64) -> f64 {
    (1.0 / most - 1.0 / largest_eigenvalue(stiffness)).max(0.0)
}

/// A touch as the coupling sees it.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Stiffness of the touched place, N/m.
    pub stiffness: DMat3,
    /// From god object to probe, m.
    pub displacement: DVec3,
    /// Force of the body on the finger (14), N.
    pub force: DVec3,
}

/// A touch after the coupling.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Coupled {
    /// The part of the displacement that the body takes, m; the spring takes the rest.
    pub body_displacement: DVec3,
    /// Force of the body and the spring, N.
    pub spring: DVec3,
    /// Force for the device before safety, N.
    pub force: DVec3,
}

/// The coupling from tick to tick.
#[derive(Debug, Clone, Copy, Default)]
pub struct Coupler {
    displacement: DVec3,
    /// Velocity of the displacement, smoothed, m/s.
    velocity: DVec3,
    passivity: Passivity,
}

impl Coupler {
    /// Couples a touch, `dt` seconds after the last tick.
    ///
    /// `scale` is how many metres of the body are one of the device, which makes every body by as
    /// much stiffer for it. With the default coupling the force is the body's own, to the bit.
    pub fn couple(
        &mut self,
        contact: &Contact,
        coupling: &Coupling,
        scale: f64,
        dt: f64,
    ) -> Coupled {
        let compliance = series_compliance(&contact.stiffness, coupling.stiffness / scale);
        let share = series_share(&contact.stiffness, compliance);
        let seen = Contact {
            stiffness: share * contact.stiffness,
            displacement: contact.displacement,
            force: share * contact.force,
        };
        Coupled {
            body_displacement: share * contact.displacement,
            spring: seen.force,
            force: self.drive(&seen, coupling, scale, dt),
        }
    }

    /// Damps and watches a touch in which the spring is already: its stiffness and force are those
    /// of the body and the spring in series. The force for the device before safety, N.
    pub fn drive(&mut self, seen: &Contact, coupling: &Coupling, scale: f64, dt: f64) -> DVec3 {
        let (spring, displacement) = (seen.force, seen.displacement);
        self.follow(displacement, dt);
        let lead = seen.stiffness * self.velocity * -coupling.lead_seconds();
        let brake = if coupling.passivity_control {
            self.passivity
                .control(spring, displacement, self.velocity, scale, dt)
        } else {
            DVec3::ZERO
        };
        spring + bounded(lead + brake, spring, displacement)
    }

    /// Tells what the device holds until the next tick.
    pub fn sent(&mut self, force: DVec3) {
        self.passivity.sent(force);
    }

    /// Forgets: nothing is touched.
    pub fn release(&mut self) {
        *self = Self::default();
    }

    fn follow(&mut self, displacement: DVec3, dt: f64) {
        let moved = (displacement - std::mem::replace(&mut self.displacement, displacement)) / dt;
        self.velocity += (moved - self.velocity) * (dt / (SMOOTHING_SECONDS + dt));
    }
}

/// Part of `added` that may go with the spring's force: none at first touch and at release, no pull.
///
/// Against the spring and across it at most as much as its own; with it some times as much, because
/// a force that comes late has to make up for the way already gone. Where the body is softer in one
/// direction than in another its force is not along the displacement, and what goes across it could
/// draw the finger in: only so much of it that the whole does not.
fn bounded(added: DVec3, spring: DVec3, displacement: DVec3) -> DVec3 {
    let size = spring.length();
    // What is no number passes, for safety to find it.
    if size.is_nan() || size == 0.0 {
        return DVec3::ZERO;
    }
    let way = spring / size;
    let along = added.dot(way);
    let across = added - way * along;
    let added = way * along.clamp(-size, MOST_GAIN * size) + shortened(across, size);
    let (inward, outward) = (added.dot(displacement), -spring.dot(displacement));
    // Among other fingers a spring may lean on its cone, and not against the displacement at all.
    let outward = outward.max(0.0);
    if inward > outward {
        added * (outward / inward)
    } else {
        added
    }
}

/// The vector, cut to `length` if it is longer.
fn shortened(v: DVec3, length: f64) -> DVec3 {
    let own = v.length();
    if own <= length { v } else { v * (length / own) }
}
