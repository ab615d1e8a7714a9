//! Time-domain passivity: an observer of the energy that the motors give, and a brake.
//!
//! After Hannaford and Ryu, "Time-domain passivity control of haptic interfaces" (2002), in the form
//! that follows a reference energy (Ryu, Preusche, Hannaford and Hirzinger 2005): the energy given is
//! compared with that of the body's own force over the same way. So nothing saved up during a long
//! press can hide what is made later, which was the weakness of the first form.

use glam::DVec3;

/// The longest delay of a device that energy is watched for, besides the holding of a tick, s.
pub const LAG_SECONDS: f64 = 2.0e-3;
/// Ticks of the longest delay at the highest rate, 2 ms at 8 kHz, and those now and before.
const MEMORY: usize = 32;
/// Friction that every device of the documented range has, N: what it takes need not be braked.
const FRICTION: f64 = 0.03;
/// Most damping, N s/m: more, itself delayed, would make energy.
const MOST_DAMPING: f64 = 1.0;
/// Largest surplus of energy taken by the device's friction, J: no credit for later.
const MOST_SURPLUS: f64 = 1.0e-6;

/// Observer and controller of one touch.
///
/// How long the device takes to obey is not known. There is an observer for every delay up to
/// [`LAG_SECONDS`], and the one that sees the most energy decides.
#[derive(Debug, Clone, Copy)]
pub struct Passivity {
    /// Forces sent, the newest first.
    held: [DVec3; MEMORY],
    /// Energy taken minus energy made, J, for each delay in ticks.
    surplus: [f64; MEMORY],
    spring: DVec3,
    displacement: DVec3,
}

impl Default for Passivity {
    fn default() -> Self {
        Self {
            held: [DVec3::ZERO; MEMORY],
            surplus: [0.0; MEMORY],
            spring: DVec3::ZERO,
            displacement: DVec3::ZERO,
        }
    }
}

impl Passivity {
    /// The brake's force, N, zero as long as no energy was made.
    ///
    /// `spring` is the body's force now, `displacement` (m) and `velocity` (m/s) are those of the
    /// probe relative to the god object, `scale` is body metres per device metre.
    pub fn control(
        &mut self,
        spring: DVec3,
        displacement: DVec3,
        velocity: DVec3,
        scale: f64,
        dt: f64,
    ) -> DVec3 {
        let way = (displacement - self.displacement) / scale;
        let reference = (spring + self.spring).dot(way) * 0.5;
        let taken = reference + FRICTION * way.length();
        let lags = ((LAG_SECONDS / dt).ceil() as usize + 1).min(MEMORY);
        let mut least = 0.0_f64;
        for (surplus, held) in self.surplus.iter_mut().zip(self.held).take(lags) {
            *surplus = (*surplus + taken - held.dot(way)).min(MOST_SURPLUS);
            least = least.min(*surplus);
        }
        (self.spring, self.displacement) = (spring, displacement);
        let speed_squared = velocity.length_squared() / (scale * scale);
        if least >= 0.0 || speed_squared == 0.0 {
            return DVec3::ZERO;
        }
        let damping = (-least / (dt * speed_squared)).min(MOST_DAMPING);
        velocity * (-damping / scale)
    }

    /// Tells what the device holds until the next tick.
    pub fn sent(&mut self, force: DVec3) {
        self.held.copy_within(..MEMORY - 1, 1);
        self.held[0] = force;
    }
}
