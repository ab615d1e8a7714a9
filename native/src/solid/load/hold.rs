//! Friction that holds places of a body where they are, as far as what presses them lets it.

use glam::{DMat3, DVec3};

/// What holds a place against going aside: a rough tool, while it presses.
#[derive(Debug, Clone, Copy)]
pub struct Hold {
    /// The displacement that it is held at, m.
    pub goal: DVec3,
    /// The tool's outward normal there.
    pub normal: DVec3,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// What presses there before anything is counted in, N at 1 Pa.
    pub push: f64,
    /// And what holds it aside.
    pub pull: DVec3,
}

/// The force aside of a stiff spring to where a place is held, beside what is counted in.
///
/// Cut at what friction gives: the slope of an energy, so that there is a rest, and by the counting Coulomb's
/// law (J. C. Simo, T. A. Laursen: An augmented Lagrangian treatment of contact problems involving friction,
/// Computers and Structures 42, 1992).
#[derive(Debug, Clone, Copy)]
pub struct Spring {
    /// What the spring would pull with.
    wanted: DVec3,
    size: f64,
    most: f64,
    firmness: f64,
    /// How far the place has gone aside.
    way: f64,
}

impl Spring {
    /// Of a place that has moved, of which a push and a pull aside are counted in.
    pub fn new(hold: &Hold, (push, pull): (f64, DVec3), moved: DVec3, firmness: f64) -> Self {
        let away = hold.goal - moved;
        let aside = away - hold.normal * hold.normal.dot(away);
        let wanted = pull + firmness * aside;
        Self {
            wanted,
            size: wanted.length(),
            most: hold.friction * push,
            firmness,
            way: aside.length(),
        }
    }

    /// Whether the place gives way.
    pub fn slides(&self) -> bool {
        self.size > self.most
    }

    /// What it pulls the place with.
    pub fn pull(&self) -> DVec3 {
        if self.slides() {
            self.wanted * (self.most / self.size)
        } else {
            self.wanted
        }
    }

    /// Energy, but for what is counted in.
    pub fn energy(&self) -> f64 {
        if self.slides() {
            self.most * (self.size - 0.5 * self.most) / self.firmness
        } else {
            0.5 * self.size * self.size / self.firmness
        }
    }

    /// By how much it resists, without what would lower its energy at once.
    pub fn resists(&self, normal: DVec3) -> DMat3 {
        let across = DMat3::IDENTITY - outer(normal, normal);
        if self.slides() {
            let along = self.wanted / self.size;
            (across - outer(along, along)) * (self.firmness * self.most / self.size)
        } else {
            across * self.firmness
        }
    }

    /// The work that is missing where a place is not held yet, or by more or less than `most` as it slides.
    pub fn missed(&self, most: f64) -> f64 {
        if self.slides() {
            (most - self.most).abs() * self.way
        } else {
            self.size * self.way + (self.size - most).max(0.0) * self.size / self.firmness
        }
    }
}

/// The dyad of two directions.
pub fn outer(one: DVec3, other: DVec3) -> DMat3 {
    DMat3::from_cols(one * other.x, one * other.y, one * other.z)
}
