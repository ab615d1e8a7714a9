//! The toll: what a finger pays where its contact point comes to a stiffer place of the body.
//!
//! A force that is the slope of the elastic energy gives back what was put in, as long as its contact
//! point stays. But a point slides on, and where the body is stiffer the same depth holds more energy,
//! which nobody has paid for: pressed in where it is soft, drawn aside and let out where it is stiff,
//! such a finger would gain (`docs/contact.md`). So the energy held is compared with the work that the
//! finger has done. What is missing, the debt, a brake takes from the way that the finger goes on:
//! against it, hence without a force at rest, where the law of contact holds as it is. Places that
//! are softer give nothing back: a credit could be carried into another path, and taken out there.
//!
//! The brake is as large as the debt asks, up to the push. It grows and turns over a short piece of the
//! way, solved implicitly, so that no step is too long for it: so it is continuous, and knows neither the
//! mesh nor the speed.

use glam::DVec3;

/// Debts are paid within about this share of the depth,
const PAYING: f64 = 0.008;
/// the brake turns within this one,
const TURNING: f64 = 0.01;
/// and grows as large as the push, or falls from there, within this one.
const GROWING: f64 = 0.1;
/// This share of the energy may be owed: work adds up from tick to tick to rounding and bends.
const FREE: f64 = 1.0e-4;
/// A contact point that moved by less than this share of the depth has stayed: then the work of the law
/// is what the energy gains, however long the step.
const SAME_PLACE: f64 = 1.0e-9;
/// No depth, m: less cannot be divided by.
const SHALLOWEST: f64 = 1.0e-100;
/// A finger at rest loses the brake within this time, s.
const REST: f64 = 0.02;

/// A point that presses, at the end of a tick.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pressed {
    /// Where the finger is, m.
    pub finger: DVec3,
    /// Its contact point at rest, m.
    pub place: DVec3,
    /// Its force on the body by the law of contact, N.
    pub push: DVec3,
    /// The energy of that law at this place and displacement, J.
    pub energy: f64,
    /// Young's modulus, Pa. Who changes it, or the law, while a finger presses, puts energy in or takes
    /// it, and owes nothing.
    pub modulus: f64,
    /// Whether the law stays.
    pub is_settled: bool,
}

/// What is owed by one finger, from tick to tick.
#[derive(Debug, Clone, Copy, Default)]
pub struct Toll {
    last: Pressed,
    /// The brake's part of what the finger last felt, as a push, N.
    against: DVec3,
    /// J.
    debt: f64,
    /// Size of the brake while the finger goes on as it did, N.
    brake: f64,
    /// Its direction, at most of unit length.
    direction: DVec3,
    is_led: bool,
}

impl Toll {
    /// The finger is off the body, and owes nothing.
    pub fn lift(&mut self, finger: DVec3, modulus: f64) {
        let last = Pressed {
            finger,
            modulus,
            ..Pressed::default()
        };
        *self = Self {
            last,
            is_led: true,
            ..Self::default()
        };
    }

    /// Where the finger was is not known, and what it owed is forgotten.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The brake on the finger, N, `dt` seconds after the last tick: at most as large as the push.
    pub fn take(&mut self, pressed: Pressed, dt: f64) -> DVec3 {
        let last = std::mem::replace(&mut self.last, pressed);
        let was_led = std::mem::replace(&mut self.is_led, true);
        let way = if was_led {
            pressed.finger - last.finger
        } else {
            DVec3::ZERO
        };
        let most = pressed.push.length();
        let depth = 2.0 * pressed.energy / most;
        let is_pressed = most > 0.0 && depth > SHALLOWEST && depth.is_finite();
        if !is_pressed {
            (self.debt, self.brake) = (0.0, 0.0);
            self.against = DVec3::ZERO;
            return DVec3::ZERO;
        }
        let length = way.length();
        self.turn(way, length, TURNING * depth, dt);
        let along = if length > 0.0 {
            self.direction.dot(way) / length
        } else {
            0.0
        };
        let gained = pressed.energy - last.energy;
        let stays = pressed.place.distance(last.place) <= SAME_PLACE * depth;
        let worked = if stays {
            gained
        } else {
            0.5 * (last.push + pressed.push).dot(way)
        };
        let is_same = was_led && pressed.modulus == last.modulus && pressed.is_settled;
        let made = if is_same { gained - worked } else { 0.0 };
        let owed = self.debt + made - 0.5 * self.against.dot(way);
        let gain = 1.0 / (PAYING * depth);
        let paid = 0.5 * length * along;
        let collected = (owed - FREE * pressed.energy).max(0.0);
        let brake = gain * collected / (1.0 + gain * paid.max(0.0));
        let change = most * length / (GROWING * depth);
        let brake = brake.clamp(self.brake - change, self.brake + change);
        self.brake = brake.clamp(0.0, most);
        self.debt = (owed - paid * self.brake).max(0.0);
        self.against = self.direction * self.brake;
        -self.against
    }

    /// Turns the brake's direction with the way; at rest there is none.
    fn turn(&mut self, way: DVec3, length: f64, turning: f64, dt: f64) {
        if length > 0.0 {
            self.direction += (way / length - self.direction) * (length / (length + turning));
        } else {
            let rest = self.direction.length() - dt / REST;
            self.direction = self.direction.normalize_or_zero() * rest.max(0.0);
        }
    }
}
