//! A finger as the toll sees it.

use glam::DVec3;

/// A contact point that moved by less than this share of the depth has stayed: then the work of the law
/// is what the energy gains, however long the step.
const SAME_PLACE: f64 = 1.0e-9;
/// A finger is as deep as with this share of its own energy at least: others may draw it along.
const LEAST_SHARE: f64 = 0.1;
/// No depth, m: less cannot be divided by.
const SHALLOWEST: f64 = 1.0e-100;

/// A finger at the end of a tick; by default it is not there, or presses nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pressed {
    /// Where the finger is, m.
    pub finger: DVec3,
    /// How far the body itself has moved what is pressed: no work of the finger's, m.
    pub carried: DVec3,
    /// It did not move there but was set down.
    pub is_set_down: bool,
    /// What its push does on the displacements that the body remembers, J.
    pub remembered: f64,
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
    /// What another firmness has put into its share in this tick, J.
    pub lent: f64,
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
    pub(super) fn sent_share(&self) -> f64 {
        let push = self.push.length();
        if push > self.law.most_force {
            self.law.most_force / push
        } else {
            1.0
        }
    }

    /// The push as far as it is sent, N.
    pub(super) fn felt(&self) -> DVec3 {
        self.push * self.sent_share()
    }

    /// The energy that is had back by going straight out, J: less where the force is cut off.
    pub(super) fn held(&self) -> f64 {
        self.energy * self.had_back()
    }

    /// The part of that which is lent, J.
    pub(super) fn lent(&self) -> f64 {
        self.lent * self.had_back()
    }

    /// Of its energy the share that is had back by going straight out.
    fn had_back(&self) -> f64 {
        let share = self.sent_share();
        share * (2.0 - share)
    }

    /// How deep it is, m; 0 unless it presses.
    pub(super) fn depth(&self) -> f64 {
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
    pub(super) fn asked(&self) -> DVec3 {
        if self.wanted.length() > self.law.most_force {
            -self.felt()
        } else {
            self.wanted
        }
    }

    pub(super) fn presses(&self) -> bool {
        self.push != DVec3::ZERO
    }

    /// Whether it presses by the law of the last tick.
    pub(super) fn presses_as(&self, last: &Self) -> bool {
        let is_same = self.law == last.law || !(self.presses() && last.presses());
        is_same && !self.is_unsettled && !last.is_unsettled
    }

    /// Whether it presses where it did, with a force that is sent whole.
    pub(super) fn stays(&self, last: &Self) -> bool {
        let is_off = !self.presses() && !last.presses();
        let nearest = SAME_PLACE * self.depth().max(last.depth());
        let moved = (self.place.zip(last.place)).map(|(now, last)| now.distance(last));
        is_off || (moved.is_some_and(|moved| moved <= nearest) && self.sent_share() == 1.0)
    }

    /// The finger's work against the push as it is sent, J, and that of who turns the tool.
    pub(super) fn work(&self, last: &Self, way: DVec3) -> f64 {
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
