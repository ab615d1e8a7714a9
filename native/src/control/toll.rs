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
//!
//! What another firmness puts into the body is lent: it is owed as well, but by those alone who go out, and of
//! each piece of the way out in proportion. Whoever goes on in has not had it, and with the share of what is held
//! that is lent kept back from every push, nothing of it is left on the surface.

use glam::DVec3;

use super::pressed::Pressed;

/// Debts are paid within about this share of the depth,
const PAYING: f64 = 0.016;
/// the brake turns within this one,
const TURNING: f64 = 0.02;
/// and grows as large as the push, or falls from there, within this one.
const GROWING: f64 = 0.2;
/// Where this share of the energy is owed, brakes take back as fast as a push gives, however short the
/// way has been; and where it is less, a share of that: what fingers have not put in, they do not get out.
const BORROWED: [f64; 2] = [0.25, 0.75];
/// This share of the energy may be owed: work adds up from tick to tick to rounding and bends.
const FREE: f64 = 1.0e-4;
/// A finger at rest loses its brake within this time, s.
const REST: f64 = 0.02;

/// Of the force of whichever finger it is cut off most, the share that is sent: with that share it has
/// worked against the body's weight.
fn least_share(pressed: &[Pressed]) -> f64 {
    let pressing = pressed.iter().filter(|finger| finger.presses());
    pressing.map(Pressed::sent_share).fold(1.0, f64::min)
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
    /// What is kept back of what is lent, as a push, N.
    kept_back: DVec3,
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
        self.direction * self.size + self.kept_back
    }

    /// The share of a push that may be kept back: all on the way straight out.
    fn outwards(&self, push: DVec3) -> f64 {
        (-self.direction.dot(push.normalize_or_zero())).max(0.0)
    }

    /// What it takes from this tick's way for each newton, J; the other half is the next tick's.
    fn paid(&self) -> f64 {
        0.5 * self.direction.dot(self.way)
    }

    /// Grows towards a size, at most as large as the push as sent, no faster than the way allows; but
    /// it is at least that share of the push. What is kept back is no longer there for it.
    fn grow(&mut self, size: f64, least: f64, pressed: &Pressed) {
        let most = (pressed.felt().length() - self.kept_back.length()).max(0.0);
        let change = most * self.way.length() / (GROWING * pressed.depth());
        let size = size.clamp(self.size - change, self.size + change);
        self.size = size.clamp(least * most, most);
    }
}

/// What a body can give back more than in the tick before besides what fingers hold, J.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given {
    /// All of it.
    pub all: f64,
    /// What another firmness has put in, of it.
    pub lent: f64,
}

/// What is owed by all fingers together, from tick to tick.
#[derive(Debug, Clone, Copy)]
pub struct Toll<const FINGERS: usize> {
    last: [Pressed; FINGERS],
    brakes: [Brake; FINGERS],
    /// All that is owed, J.
    debt: f64,
    /// What is lent of it, J.
    lent: f64,
    /// Whether the accounts of this tick can be kept.
    is_kept: bool,
}

impl<const FINGERS: usize> Default for Toll<FINGERS> {
    fn default() -> Self {
        Self {
            last: [Pressed::default(); FINGERS],
            brakes: [Brake::default(); FINGERS],
            debt: 0.0,
            lent: 0.0,
            is_kept: false,
        }
    }
}

impl<const FINGERS: usize> Toll<FINGERS> {
    /// The brakes on the fingers, N, `dt` seconds after the last tick; `beside` is what the body can
    /// give back more than then besides what the fingers hold, as one that nobody holds may.
    pub fn take(
        &mut self,
        pressed: &[Pressed; FINGERS],
        beside: &Given,
        dt: f64,
    ) -> [DVec3; FINGERS] {
        let last = std::mem::replace(&mut self.last, *pressed);
        let held: f64 = pressed.iter().map(Pressed::held).sum();
        if held.is_nan() || held <= 0.0 {
            self.brakes = [Brake::default(); FINGERS];
            (self.debt, self.lent, self.is_kept) = (0.0, 0.0, false);
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
            let lent: f64 = pressed.iter().map(Pressed::lent).sum();
            let share = least_share(pressed);
            self.debt += self.made(pressed, &last) + lent + beside.all * share;
            self.lent += lent + beside.lent * share;
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
        self.lent = self.lent.min(self.debt);
    }

    /// What the energy gained beyond the work of the fingers, but for this tick's brakes, J.
    fn made(&self, pressed: &[Pressed; FINGERS], last: &[Pressed; FINGERS]) -> f64 {
        let stay = (pressed.iter().zip(last)).all(|(now, last)| now.stays(last));
        let fingers = pressed.iter().zip(last).zip(&self.brakes);
        let made = fingers.map(|((now, last), brake)| {
            let by_law = if stay {
                0.0
            } else {
                now.held() - now.lent() - last.held() - now.work(last, brake.way - now.carried)
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
        self.keep_back(pressed, held);
        let owed = self.debt - self.lent;
        let left = (owed - FREE * held).max(0.0) / (1.0 + steepness);
        let [some, all] = BORROWED;
        let least = ((owed / held - some) / (all - some)).clamp(0.0, 1.0);
        for (brake, pressed) in self.brakes.iter_mut().zip(pressed) {
            let depth = pressed.depth();
            if depth > 0.0 {
                brake.grow(left / (PAYING * depth), least, pressed);
                self.debt -= brake.paid() * brake.size;
            } else {
                (brake.size, brake.direction) = (0.0, DVec3::ZERO);
            }
        }
    }

    /// Keeps back of the pushes on those who go out the share that is lent of what is held.
    fn keep_back(&mut self, pressed: &[Pressed; FINGERS], held: f64) {
        // Half by what is kept back of this tick's pushes, half by what was of the last one's.
        let (mut now, mut before) = (0.0, 0.0);
        for (brake, pressed) in self.brakes.iter().zip(pressed) {
            let push = pressed.felt();
            before += 0.5 * brake.kept_back.dot(brake.way);
            now -= 0.5 * brake.outwards(push) * push.dot(brake.way);
        }
        let left = (self.lent - before) / (1.0 + now.max(0.0) / held);
        let share = (left / held).clamp(0.0, 1.0);
        for (brake, pressed) in self.brakes.iter_mut().zip(pressed) {
            let push = pressed.felt();
            brake.kept_back = -push * (share * brake.outwards(push));
        }
        self.lent = (self.lent - before - share * now).clamp(0.0, held);
        self.debt -= share * now;
    }
}
