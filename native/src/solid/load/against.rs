//! Tools that a body is kept out of: contact in which its places press and never hold, and rough tools hold them
//! against going aside.

use glam::{DMat3, DVec3};

use super::doing::{Doing, changed};
use super::hold::{Spring, outer};
use super::place::Place;
use super::yielding::Yielding;
use crate::solid::domains::Nodal;
use crate::tool::shape::{Pose, Tool};

/// The share of all places, one in so many, by which those that press may differ from those known, and those
/// that slide.
const ALIKE: usize = 40;
const SLIDING_ALIKE: usize = 10;

/// With no more unrest than is missing it is counted in where friction is, whose bound has to be found, too; and
/// with no more than this, as a share of all work: what is counted in far from rest leads farther away.
const EARLY: f64 = 0.03;

/// Tools where they are, and the places that they may meet.
///
/// Each place is a stiff spring while it is within its tool; what it pushes with is counted in (augmented
/// Lagrangian, J. Nocedal, S. J. Wright: Numerical Optimization, 2nd edition, 2006, section 17.3), so that
/// no place stays within. What holds it aside is another, cut at its friction times what was counted in last.
#[derive(Debug, Clone)]
pub struct Against {
    places: Vec<Place>,
    tools: Vec<(Tool, Pose)>,
    /// Of the nodes known, by rows.
    compliance: Vec<DMat3>,
    known: usize,
    /// What is counted in of pushes, and of pulls aside, N.
    counted: Vec<f64>,
    pulls: Vec<DVec3>,
    /// Whether places stay on springs, as on a bed: nothing is counted in.
    pub gives: bool,
    /// What the places did when the body was last looked at, and how it yields under that.
    doing: Vec<Doing>,
    yielding: Yielding,
}

impl Against {
    /// None where sizes differ.
    pub fn new(
        places: Vec<Place>,
        tools: Vec<(Tool, Pose)>,
        compliance: Vec<DMat3>,
        known: usize,
        nodes: usize,
    ) -> Option<Self> {
        let is_within = |place: &Place| {
            place.tool < tools.len()
                && place.corners.iter().all(|&node| (node as usize) < nodes)
                && place.known.iter().all(|&node| (node as usize) < known)
        };
        let fits = compliance.len() == known * known && places.iter().all(is_within);
        let at_first = |place: &Place| {
            place.hold.map_or((0.0, DVec3::ZERO), |hold| {
                let most = hold.friction * hold.push;
                (hold.push, hold.pull.clamp_length_max(most))
            })
        };
        let (counted, pulls) = places.iter().map(at_first).unzip();
        fits.then(|| Self {
            counted,
            pulls,
            places,
            tools,
            compliance,
            known,
            gives: false,
            doing: Vec::new(),
            yielding: Yielding::default(),
        })
    }

    /// The force on each place, N.
    pub fn pushes(&self, warped: &Nodal) -> Vec<DVec3> {
        (0..self.places.len())
            .map(|one| self.force(one, warped))
            .collect()
    }

    /// The work that is missing where places are still within, or not held as they are to be, J.
    pub fn missed(&self, warped: &Nodal) -> f64 {
        if self.gives {
            return 0.0;
        }
        (0..self.places.len())
            .map(|one| {
                let (push, _, depth) = self.push(one, warped);
                let aside = self
                    .aside(one, warped)
                    .map_or(0.0, |spring| spring.missed(self.friction(one) * push));
                push * depth.abs() + aside
            })
            .sum()
    }

    /// At what unrest to count in what pushes and holds, where so much is missing: the less it is the later.
    pub fn enough(&self, missed: f64) -> f64 {
        let holds = self.places.iter().any(|place| place.hold.is_some());
        if holds { missed.min(EARLY) } else { 0.0 }
    }

    /// Counts in what pushes and holds there.
    pub fn count_in(&mut self, warped: &Nodal) {
        let found: Vec<_> = (0..self.places.len())
            .map(|one| {
                let push = self.push(one, warped).0;
                let pull = self
                    .aside(one, warped)
                    .map_or(DVec3::ZERO, |spring| spring.pull());
                (push, pull.clamp_length_max(self.friction(one) * push))
            })
            .collect();
        (self.counted, self.pulls) = found.into_iter().unzip();
    }

    /// Looks at what presses there, for [`Self::held_back`].
    pub fn look(&mut self, warped: &Nodal) {
        let (mut doing, mut springs) = (Vec::new(), Vec::new());
        for place in 0..self.places.len() {
            let (push, normal, _) = self.push(place, warped);
            let aside = self
                .aside(place, warped)
                .filter(|_| self.counted[place] > 0.0);
            if push == 0.0 && aside.is_none() {
                continue;
            }
            let mut spring = DMat3::ZERO;
            if push > 0.0 {
                spring += outer(normal, normal) * self.places[place].firmness;
            }
            if let (Some(aside), Some(hold)) = (&aside, &self.places[place].hold) {
                spring += aside.resists(hold.normal);
            }
            springs.push((place, spring));
            doing.push(Doing {
                place,
                presses: push > 0.0,
                slides: aside.map(|spring| spring.slides()),
            });
        }
        // Almost the same places: steps are chosen as well by these, which press to where they did.
        let (pressing, sliding) = changed(&self.doing, &doing);
        if pressing <= doing.len() / ALIKE && sliding <= doing.len() / SLIDING_ALIKE {
            return;
        }
        self.doing = doing;
        (self.yielding).set(springs, &self.places, &self.compliance, self.known);
    }

    /// `forces` become those by which the springs of what presses hold back a displacement that the body alone
    /// would make.
    pub(in crate::solid) fn held_back(&self, solved: &Nodal, forces: &mut Nodal) {
        self.yielding.held_back(&self.places, solved, forces);
    }

    pub(in crate::solid) fn energy(&self, warped: &Nodal) -> f64 {
        (0..self.places.len())
            .map(|one| {
                let (push, counted) = (self.push(one, warped).0, self.counted[one]);
                let firmness = self.places[one].firmness;
                let pressed = (push * push - counted * counted) / (2.0 * firmness);
                let aside = self.aside(one, warped).map_or(0.0, |spring| {
                    spring.energy() - self.pulls[one].length_squared() / (2.0 * firmness)
                });
                pressed + aside
            })
            .sum()
    }

    /// Takes what pushes and holds from the forces that hold the body.
    pub(in crate::solid) fn take_from(&self, warped: &Nodal, forces: &mut Nodal) {
        for (one, place) in self.places.iter().enumerate() {
            place.add(-self.force(one, warped), forces);
        }
    }

    fn force(&self, one: usize, warped: &Nodal) -> DVec3 {
        let (push, normal, _) = self.push(one, warped);
        let aside = self.aside(one, warped);
        push * normal + aside.map_or(DVec3::ZERO, |spring| spring.pull())
    }

    /// By how much a place pushes, N, where to, and how deep it is within.
    fn push(&self, one: usize, warped: &Nodal) -> (f64, DVec3, f64) {
        let place = &self.places[one];
        let (tool, pose) = &self.tools[place.tool];
        let there = place.rest + place.mean(warped);
        let (distance, normal) = tool.distance(pose.to_tool(there));
        let push = (self.counted[one] - place.firmness * distance).max(0.0);
        (push, pose.rotation * normal, -distance)
    }

    /// What holds a place against going aside.
    fn aside(&self, one: usize, warped: &Nodal) -> Option<Spring> {
        let place = &self.places[one];
        let hold = place.hold.as_ref()?;
        let counted = (self.counted[one], self.pulls[one]);
        Some(Spring::new(
            hold,
            counted,
            place.mean(warped),
            place.firmness,
        ))
    }

    fn friction(&self, one: usize) -> f64 {
        (self.places[one].hold).map_or(0.0, |hold| hold.friction)
    }
}

#[cfg(test)]
mod tests;
