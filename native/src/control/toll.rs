//! The toll: what fingers pay for energy that the body gains and nobody has put in.
//!
//! Forces that are the slope of the elastic energy give back what was put in, as those of tools do and
//! of points whose contact points stay. But points slide on, and where the body is stiffer the same
//! depth holds more energy: pressed in where it is soft, drawn aside and let out where it is stiff,
//! such a finger would gain (`docs/contact.md`). And deep in the body a tool's pushes are held near a
//! direction that changes with them (`docs/fingertip.md`). So the energy held is compared with the work
//! of all fingers together, for what one has put in another may take out. What is missing, the debt, brakes
//! take from the ways that the fingers go on: against them, hence without a force at rest, where the
//! law of contact holds as it is. Places that are softer give nothing back: a credit could be carried
//! into another path, and taken out there.
//!
//! The accounts are those of the forces as sent: what the limits cut off a force was not worked
//! against, and what they cut off a brake was not paid.
//!
//! A brake is as large as the debt asks, up to the push as sent. It grows and turns over a short piece of the
//! way, solved implicitly, so that no step is too long for it: so it is continuous, and knows neither the
//! mesh nor the speed.

use glam::DVec3;

/// Debts are paid within about this share of the depth,
const PAYING: f64 = 0.016;
/// the brake turns within this one,
const TURNING: f64 = 0.02;
/// and grows as large as the push, or falls from there, within this one.
const GROWING: f64 = 0.2;
/// This share of the energy may be owed: work adds up from tick to tick to rounding and bends.
const FREE: f64 = 1.0e-4;
/// A contact point that moved by less than this share of the depth has stayed: then the work of the law
/// is what the energy gains, however long the step.
const SAME_PLACE: f64 = 1.0e-9;
/// A finger is as deep as with this share of its own energy at least: others may draw it along.
const LEAST_SHARE: f64 = 0.1;
/// No depth, m: less cannot be divided by.
const SHALLOWEST: f64 = 1.0e-100;
/// A finger at rest loses its brake within this time, s.
const REST: f64 = 0.02;

/// A finger at the end of a tick; by default it is not there, or presses nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pressed {
    /// Where the finger is, m.
    pub finger: DVec3,
    /// How far the body itself has moved what is pressed: no work of the finger's, m.
    pub carried: DVec3,
    /// It did not move there but was set down.
    pub is_set_down: bool,
    /// Its contact point at rest, m; a tool has none.
    pub place: Option<DVec3>,
    /// How far a tool was turned in this tick, about an axis by its length in rad.
    pub turn: DVec3,
    /// The torque with which a tool turns the body by the law, N m.
    pub torque: DVec3,
    /// Its force on the body by the law of contact, N.
    pub push: DVec3,
    /// Its share of the energy of all by that law at these places and displacements, J.
    pub energy: f64,
    /// What its own force alone puts into the body, J.
    pub own_energy: f64,
    /// What is asked of the motors but for a brake, N.
    pub wanted: DVec3,
    /// By which law it presses.
    pub law: Law,
    /// That law is not known, or changes, or its force is not sent whole.
    pub is_unsettled: bool,
}

/// What the law depends on but for places and displacements. Who changes it while a finger presses
/// puts energy in or takes it, and owes nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Law {
    /// Young's modulus, Pa.
    pub modulus: f64,
    /// The most that motors see of the body's stiffness, N/m.
    pub most_stiffness: f64,
    /// The largest force that is sent, N.
    pub most_force: f64,
}

impl Pressed {
    /// Of a force of this size, N, the share that is sent.
    fn sent_share(&self) -> f64 {
        let push = self.push.length();
        if push > self.law.most_force {
            self.law.most_force / push
        } else {
            1.0
        }
    }

    /// The push as far as it is sent, N.
    fn felt(&self) -> DVec3 {
        self.push * self.sent_share()
    }

    /// The energy that is had back by going straight out, J: less where the force is cut off.
    fn held(&self) -> f64 {
        let share = self.sent_share();
        self.energy * share * (2.0 - share)
    }

    /// How deep it is, m; 0 unless it presses.
    fn depth(&self) -> f64 {
        let energy = self.energy.max(LEAST_SHARE * self.own_energy);
        let depth = 2.0 * energy / self.push.length();
        if depth > SHALLOWEST && depth.is_finite() {
            depth
        } else {
            0.0
        }
    }

    /// What is to be sent without a brake, N. Damping is left out, for it takes; cut off together with
    /// the law's force it need not, and is counted.
    fn asked(&self) -> DVec3 {
        if self.wanted.length() > self.law.most_force {
            -self.felt()
        } else {
            self.wanted
        }
    }

    fn presses(&self) -> bool {
        self.push != DVec3::ZERO
    }

    /// Whether it presses by the law of the last tick.
    fn presses_as(&self, last: &Self) -> bool {
        let is_same = self.law == last.law || !(self.presses() && last.presses());
        is_same && !self.is_unsettled && !last.is_unsettled
    }

    /// Whether it presses where it did, with a force that is sent whole.
    fn stays(&self, last: &Self) -> bool {
        let is_off = !self.presses() && !last.presses();
        let nearest = SAME_PLACE * self.depth().max(last.depth());
        let moved = (self.place.zip(last.place)).map(|(now, last)| now.distance(last));
        is_off || (moved.is_some_and(|moved| moved <= nearest) && self.sent_share() == 1.0)
    }

    /// The finger's work against the push as it is sent, J, and that of who turns the tool.
    fn work(&self, last: &Self, way: DVec3) -> f64 {
        let turned = self.torque * self.sent_share() + last.torque * last.sent_share();
        let work = 0.5 * ((last.felt() + self.felt()).dot(way) + turned.dot(self.turn));
        if self.presses() {
            work
        } else {
            // The rest of the way out was in the air.
            work.max(-last.held())
        }
    }
}

/// The brake of one finger.
#[derive(Debug, Clone, Copy, Default)]
struct Brake {
    /// Its size while the finger goes on as it did, N.
    size: f64,
    /// Its direction, at most of unit length.
    direction: DVec3,
    /// The finger's way in this tick, m.
    way: DVec3,
    /// What was sent less than asked, with the brake, N.
    beside: DVec3,
}

impl Brake {
    /// Turns its direction with the way; at rest there is none.
    fn turn(&mut self, turning: f64, dt: f64) {
        let length = self.way.length();
        if length > 0.0 {
            let ahead = self.way / length - self.direction;
            self.direction += ahead * (length / (length + turning));
        } else {
            let rest = self.direction.length() - dt / REST;
            self.direction = self.direction.normalize_or_zero() * rest.max(0.0);
        }
    }

    /// As a push, N.
    fn force(&self) -> DVec3 {
        self.direction * self.size
    }

    /// What it takes from this tick's way for each newton, J; the other half is the next tick's.
    fn paid(&self) -> f64 {
        0.5 * self.direction.dot(self.way)
    }

    /// Grows towards a size, at most as large as the push as sent, no faster than the way allows.
    fn grow(&mut self, size: f64, pressed: &Pressed) {
        let most = pressed.felt().length();
        let change = most * self.way.length() / (GROWING * pressed.depth());
        let size = size.clamp(self.size - change, self.size + change);
        self.size = size.clamp(0.0, most);
    }
}

/// What is owed by all fingers together, from tick to tick.
#[derive(Debug, Clone, Copy)]
pub struct Toll<const FINGERS: usize> {
    last: [Pressed; FINGERS],
    brakes: [Brake; FINGERS],
    /// J.
    debt: f64,
    /// Whether the accounts of this tick can be kept.
    is_kept: bool,
}

impl<const FINGERS: usize> Default for Toll<FINGERS> {
    fn default() -> Self {
        Self {
            last: [Pressed::default(); FINGERS],
            brakes: [Brake::default(); FINGERS],
            debt: 0.0,
            is_kept: false,
        }
    }
}

impl<const FINGERS: usize> Toll<FINGERS> {
    /// The brakes on the fingers, N, `dt` seconds after the last tick.
    pub fn take(&mut self, pressed: &[Pressed; FINGERS], dt: f64) -> [DVec3; FINGERS] {
        let last = std::mem::replace(&mut self.last, *pressed);
        let held: f64 = pressed.iter().map(Pressed::held).sum();
        if held <= 0.0 {
            self.brakes = [Brake::default(); FINGERS];
            (self.debt, self.is_kept) = (0.0, false);
            return [DVec3::ZERO; FINGERS];
        }
        for ((brake, now), last) in self.brakes.iter_mut().zip(pressed).zip(&last) {
            let is_led = !now.is_set_down;
            brake.way = if is_led {
                now.finger - last.finger
            } else {
                DVec3::ZERO
            };
        }
        self.is_kept = (pressed.iter().zip(&last)).all(|(now, last)| now.presses_as(last));
        if self.is_kept {
            self.debt += self.made(pressed, &last);
        }
        self.brake(pressed, held, dt);
        self.brakes.map(|brake| -brake.force())
    }

    /// Tells what the devices hold until the next tick, N; none where no force is given.
    pub fn sent(&mut self, forces: &[Option<DVec3>; FINGERS]) {
        for ((brake, force), pressed) in self.brakes.iter_mut().zip(forces).zip(&self.last) {
            let Some(force) = force.filter(|_| pressed.presses()) else {
                brake.beside = DVec3::ZERO;
                continue;
            };
            let beside = pressed.asked() - force;
            if self.is_kept {
                self.debt += 0.5 * (brake.force() - beside).dot(brake.way);
            }
            brake.beside = beside;
        }
        self.debt = self.debt.max(0.0);
    }

    /// What the energy gained beyond the work of the fingers, but for this tick's brakes, J.
    fn made(&self, pressed: &[Pressed; FINGERS], last: &[Pressed; FINGERS]) -> f64 {
        let stay = (pressed.iter().zip(last)).all(|(now, last)| now.stays(last));
        let fingers = pressed.iter().zip(last).zip(&self.brakes);
        let made = fingers.map(|((now, last), brake)| {
            let by_law = if stay {
                0.0
            } else {
                now.held() - last.held() - now.work(last, brake.way - now.carried)
            };
            by_law - 0.5 * brake.beside.dot(brake.way)
        });
        made.sum()
    }

    /// Brakes that take the debt from the ways, and what is left of it.
    fn brake(&mut self, pressed: &[Pressed; FINGERS], held: f64, dt: f64) {
        let mut steepness = 0.0;
        for (brake, pressed) in self.brakes.iter_mut().zip(pressed) {
            let depth = pressed.depth();
            if depth > 0.0 {
                brake.turn(TURNING * depth, dt);
                steepness += brake.paid().max(0.0) / (PAYING * depth);
            }
        }
        let left = (self.debt - FREE * held).max(0.0) / (1.0 + steepness);
        for (brake, pressed) in self.brakes.iter_mut().zip(pressed) {
            let depth = pressed.depth();
            if depth > 0.0 {
                brake.grow(left / (PAYING * depth), pressed);
                self.debt -= brake.paid() * brake.size;
            } else {
                (brake.size, brake.direction) = (0.0, DVec3::ZERO);
            }
        }
    }
}
