//! A contact point of a body, and what it meets.

use glam::DVec3;

use super::outline::known::Known;
use crate::contact::fading::fading;

/// Points of the other body that carry a contact's force at most.
pub(super) const MOST_SHARES: usize = 16;

/// Contact points that carry a force, and their shares.
#[derive(Debug, Clone, Copy)]
pub struct Shares {
    count: usize,
    shares: [(u32, f64); MOST_SHARES],
}

impl Shares {
    /// Nobody carries anything yet.
    pub(super) const NONE: Self = Self {
        count: 0,
        shares: [(0, 0.0); MOST_SHARES],
    };

    /// Adds one; there must be room.
    pub(super) fn push(&mut self, point: u32, share: f64) {
        self.shares[self.count] = (point, share);
        self.count += 1;
    }

    /// Whether they are those of the same points, within so much of each.
    pub(super) fn is_near(&self, other: &Self, most: f64) -> bool {
        self.count == other.count
            && (self.iter().zip(other.iter()))
                .all(|(one, two)| one.0 == two.0 && (one.1 - two.1).abs() <= most)
    }
}

impl std::ops::Deref for Shares {
    type Target = [(u32, f64)];

    #[inline]
    fn deref(&self) -> &[(u32, f64)] {
        &self.shares[..self.count]
    }
}

/// What a point meets, by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Against {
    /// A tool that a hand leads.
    Finger(usize),
    /// A rigid one that bears.
    Obstacle(usize),
    /// Another body.
    Body(usize),
}

/// A contact point near something.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Whose point it is, by number.
    pub body: usize,
    /// Number of the contact point there.
    pub point: u32,
    /// It carries its own force.
    own: [(u32, f64); 1],
    /// What it meets.
    pub against: Against,
    /// Contact points of the other body that carry the force there, and their shares.
    pub shares: Shares,
    /// Where the point is on the other, in whose frame, at rest, m.
    pub place: DVec3,
    /// Triangle of the other body that it met there.
    pub(super) triangle: u32,
    /// Triangles around it there.
    pub(super) known: Known,
    /// Out of the other, in the world.
    pub normal: DVec3,
    /// From the other, m.
    pub gap: f64,
    /// How deep in another body it does not press yet, m.
    pub(super) within: f64,
    /// How much it is on the other, from 1 to 0 beyond an edge.
    pub(super) presence: f64,
    /// Force on the point's body along the normal, N.
    pub push: f64,
    /// How much more it gives way than its bodies do, m/N, and as a share of how they do.
    pub(super) spring: f64,
    pub(super) fading: f64,
    /// Force on it across, by friction, in the world, N.
    pub aside: DVec3,
    /// Where on the other the point stuck.
    pub(super) anchor: Option<DVec3>,
    /// It slipped in the last tick.
    pub(super) slips: bool,
}

impl Contact {
    /// One without force, of which nothing is known yet.
    pub(super) fn new(body: usize, point: u32, against: Against) -> Self {
        Self {
            body,
            point,
            own: [(point, 1.0)],
            against,
            shares: Shares::NONE,
            place: DVec3::ZERO,
            triangle: 0,
            known: Known::NOTHING,
            normal: DVec3::ZERO,
            gap: f64::INFINITY,
            within: 0.0,
            presence: 1.0,
            push: 0.0,
            spring: 0.0,
            fading: 0.0,
            aside: DVec3::ZERO,
            anchor: None,
            slips: false,
        }
    }

    /// Force on the point's body, in the world, N; on the other its opposite acts.
    #[inline]
    pub fn force(&self) -> DVec3 {
        self.normal * self.push + self.aside
    }

    /// A point within another body is let out by so much, m. What it is deeper in than its push tells,
    /// by more than `unseen`, it does not press yet: as it went over an edge another face was found, or
    /// it is more on the body than it was.
    pub(super) fn come_out(&mut self, by: f64, unseen: f64) {
        if self.other().is_none() || self.gap.is_infinite() {
            return;
        }
        let deep = (self.within - self.gap).max(0.0);
        let within = (self.within - by).clamp(0.0, deep);
        let fades = if self.fading > 0.0 {
            (fading(self.presence) / self.fading).min(1.0)
        } else {
            0.0
        };
        let told = fades * self.spring * self.push;
        let jump = self.within - within - self.gap - told - unseen;
        let within = within + jump.max(0.0);
        self.gap += within - self.within;
        self.within = within;
    }

    /// What is to be kept first where there is no room for all: what presses, then what is near.
    #[inline]
    pub(super) fn rank(&self) -> f64 {
        if self.push > 0.0 {
            f64::NEG_INFINITY
        } else {
            self.gap
        }
    }

    /// How many times its force acts on a body: once, against, or not at all.
    #[inline]
    pub(super) fn sign_on(&self, body: usize) -> f64 {
        if self.body == body {
            1.0
        } else if self.other() == Some(body) {
            -1.0
        } else {
            0.0
        }
    }

    /// The other body, if it is one.
    #[inline]
    pub(super) fn other(&self) -> Option<usize> {
        match self.against {
            Against::Body(number) => Some(number),
            Against::Finger(_) | Against::Obstacle(_) => None,
        }
    }

    /// Contact points of a body that carry its force there, and their shares.
    #[inline]
    pub(super) fn shares_on(&self, body: usize) -> &[(u32, f64)] {
        if self.body == body {
            &self.own
        } else if self.other() == Some(body) {
            &self.shares
        } else {
            &[]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(gap: f64) -> Contact {
        Contact {
            gap,
            ..Contact::new(0, 0, Against::Body(1))
        }
    }

    #[test]
    fn one_found_deep_within_comes_out_little_by_little() {
        let mut found = contact(-1.0);
        found.come_out(0.1, 0.2);
        assert!((found.gap + 0.2).abs() < 1e-12 && (found.within - 0.8).abs() < 1e-12);
        // Pushed out by what it presses, it is let out by as much more.
        found.gap = 0.0;
        found.come_out(0.1, 0.2);
        assert!((found.gap + 0.1).abs() < 1e-12 && (found.within - 0.7).abs() < 1e-12);
        // It has come out by itself.
        found.gap = 0.9;
        found.come_out(0.1, 0.2);
        assert!(found.within == 0.0 && (found.gap - 0.2).abs() < 1e-12);
    }

    #[test]
    fn one_that_fades_in_beside_an_edge_does_not_press_all_at_once() {
        let mut faded = Contact {
            presence: 0.5,
            push: 2.0,
            spring: 0.25,
            fading: fading(0.5),
            ..contact(-0.5)
        };
        faded.come_out(0.01, 0.02);
        assert_eq!(faded.within, 0.0);
        faded.presence = 1.0;
        faded.come_out(0.01, 0.02);
        assert!((faded.within - 0.48).abs() < 1e-12);
    }

    #[test]
    fn a_rigid_tool_presses_at_once() {
        let mut rigid = Contact {
            gap: -1.0,
            ..Contact::new(0, 0, Against::Obstacle(0))
        };
        rigid.come_out(0.1, 0.2);
        assert_eq!(rigid.gap, -1.0);
    }
}
