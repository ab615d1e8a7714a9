//! Tools that a body is kept out of: contact without friction, in which its places press and never hold.

use glam::{DMat3, DVec3};

use super::place::Place;
use crate::algebra::cholesky::dot;
use crate::solid::domains::Nodal;
use crate::tool::shape::{Pose, Tool};

/// The share of all places, one in so many, by which those that press may differ from those known.
const ALIKE: usize = 40;

/// Tools where they are, and the places that they may meet.
///
/// Each place is a stiff spring while it is within its tool; what it pushes with is counted in (augmented
/// Lagrangian, J. Nocedal, S. J. Wright: Numerical Optimization, 2nd edition, 2006, section 17.3), so that
/// no place stays within.
#[derive(Debug, Clone)]
pub struct Against {
    places: Vec<Place>,
    tools: Vec<(Tool, Pose)>,
    /// Of the nodes known, by rows.
    compliance: Vec<DMat3>,
    known: usize,
    counted: Vec<f64>,
    /// Those that press, and where to, when the body was last looked at.
    pressing: Vec<(usize, DVec3)>,
    /// Cholesky's factor of what they yield and the body yields under them, by rows.
    lower: Vec<f64>,
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
        fits.then(|| Self {
            counted: vec![0.0; places.len()],
            places,
            tools,
            compliance,
            known,
            pressing: Vec::new(),
            lower: Vec::new(),
        })
    }

    /// The force on each place, N.
    pub fn pushes(&self, warped: &Nodal) -> Vec<DVec3> {
        (0..self.places.len())
            .map(|one| {
                let (push, normal, _) = self.push(one, warped);
                push * normal
            })
            .collect()
    }

    /// The work that is missing where places are still within, J.
    pub fn missed(&self, warped: &Nodal) -> f64 {
        (0..self.places.len())
            .map(|one| {
                let (push, _, depth) = self.push(one, warped);
                push * depth.abs()
            })
            .sum()
    }

    /// Counts in what pushes there.
    pub fn count_in(&mut self, warped: &Nodal) {
        self.counted = (0..self.places.len())
            .map(|one| self.push(one, warped).0)
            .collect();
    }

    /// Looks at what presses there, for [`Self::held_back`].
    pub fn look(&mut self, warped: &Nodal) {
        let pressing: Vec<_> = (0..self.places.len())
            .filter_map(|one| {
                let (push, normal, _) = self.push(one, warped);
                (push > 0.0).then_some((one, normal))
            })
            .collect();
        // Almost the same places: steps are chosen as well by these, which press to where they did.
        if self.changed(&pressing) <= pressing.len() / ALIKE {
            return;
        }
        self.pressing = pressing;
        let count = self.pressing.len();
        self.lower.clear();
        self.lower.resize(count * count, 0.0);
        for row in 0..count {
            for column in 0..=row {
                let own = if row == column {
                    1.0 / self.places[self.pressing[row].0].firmness
                } else {
                    0.0
                };
                let (done, before) = self.lower.split_at(row * count);
                let beside = if column == row {
                    &before[..column]
                } else {
                    &done[column * count..column * count + column]
                };
                let less = dot(&before[..column], beside);
                let left = own + self.yields(row, column) - less;
                self.lower[row * count + column] = if row == column {
                    // Places that the rounding of the compliance makes one yield a little more.
                    left.max(1e-3 * own).sqrt()
                } else {
                    left / self.lower[column * count + column]
                };
            }
        }
    }

    /// How many places press of which the other ones do not.
    fn changed(&self, pressing: &[(usize, DVec3)]) -> usize {
        let (mut before, mut now) = (self.pressing.iter().peekable(), pressing.iter().peekable());
        let mut changed = 0;
        while let (Some(one), Some(other)) = (before.peek(), now.peek()) {
            let (one, other) = (one.0, other.0);
            changed += usize::from(one != other);
            before.next_if(|_| one <= other);
            now.next_if(|_| other <= one);
        }
        changed + before.count() + now.count()
    }

    /// `forces` become those by which the springs of what presses hold back a displacement that the body alone
    /// would make.
    pub(in crate::solid) fn held_back(&self, solved: &Nodal, forces: &mut Nodal) {
        forces.fill([0.0; 3]);
        let count = self.pressing.len();
        let mut ways: Vec<f64> = (self.pressing.iter())
            .map(|&(one, normal)| normal.dot(self.places[one].mean(solved)))
            .collect();
        for row in 0..count {
            let from = row * count;
            let less = dot(&self.lower[from..from + row], &ways[..row]);
            ways[row] = (ways[row] - less) / self.lower[from + row];
        }
        for row in (0..count).rev() {
            ways[row] /= self.lower[row * count + row];
            for column in 0..row {
                ways[column] -= self.lower[row * count + column] * ways[row];
            }
        }
        for (&(one, normal), way) in self.pressing.iter().zip(ways) {
            self.places[one].add(way * normal, forces);
        }
    }

    pub(in crate::solid) fn energy(&self, warped: &Nodal) -> f64 {
        (0..self.places.len())
            .map(|one| {
                let (push, counted) = (self.push(one, warped).0, self.counted[one]);
                (push * push - counted * counted) / (2.0 * self.places[one].firmness)
            })
            .sum()
    }

    /// Takes what pushes from the forces that hold the body.
    pub(in crate::solid) fn take_from(&self, warped: &Nodal, forces: &mut Nodal) {
        for (one, place) in self.places.iter().enumerate() {
            let (push, normal, _) = self.push(one, warped);
            place.add(-push * normal, forces);
        }
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

    /// How far the linear body moves at one place that presses under the force of another.
    fn yields(&self, row: usize, column: usize) -> f64 {
        let ((one, to), (other, from)) = (self.pressing[row], self.pressing[column]);
        let (one, other) = (&self.places[one], &self.places[other]);
        let mut moved = DVec3::ZERO;
        for (&a, &share) in one.known.iter().zip(&one.alpha) {
            for (&b, &more) in other.known.iter().zip(&other.alpha) {
                moved +=
                    share * more * (self.compliance[a as usize * self.known + b as usize] * from);
            }
        }
        to.dot(moved)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::history::scale;

    /// A ball of 1 m whose front is 0.1 m below a triangle that yields 0.5 m/N.
    fn pressed() -> Against {
        let places = [[4.0, 1.0, 1.0], [1.0, 4.0, 1.0]].map(|alpha| Place {
            corners: [0, 1, 2],
            known: [0, 1, 2],
            alpha: alpha.map(|share| share / 6.0),
            rest: DVec3::new(0.1 * alpha[0], 0.02 * alpha[1], 0.0),
            firmness: 7.0,
            tool: 0,
        });
        let ball = Tool::new(&[DVec3::ZERO], 1.0).expect("a ball");
        let pose = Pose {
            position: DVec3::new(0.1, 0.0, 0.9),
            rotation: DMat3::IDENTITY,
        };
        let mut compliance = vec![DMat3::ZERO; 9];
        for node in 0..3 {
            compliance[4 * node] = 0.5 * DMat3::IDENTITY;
        }
        Against::new(places.to_vec(), vec![(ball, pose)], compliance, 3, 3).expect("it fits")
    }

    #[test]
    fn its_forces_are_the_slope_of_its_energy() {
        let mut against = pressed();
        let mut moved = vec![[0.01, 0.02, 0.005], [0.0, -0.01, 0.02], [0.02, 0.0, -0.01]];
        for counted in [false, true] {
            if counted {
                against.count_in(&moved);
                scale(&mut moved, 0.5);
            }
            let mut forces = vec![[0.0; 3]; 3];
            against.take_from(&moved, &mut forces);
            for node in 0..3 {
                for axis in 0..3 {
                    let mut energies = [0.0; 2];
                    for (energy, step) in energies.iter_mut().zip([1e-6, -1e-6]) {
                        let mut beside = moved.clone();
                        beside[node][axis] += step;
                        *energy = against.energy(&beside);
                    }
                    let slope = (energies[0] - energies[1]) / 2e-6;
                    assert!((slope - forces[node][axis]).abs() < 1e-7);
                }
            }
            assert!(forces.iter().any(|force| force[2].abs() > 0.01));
        }
    }

    #[test]
    fn what_presses_holds_back_as_springs_on_a_linear_body_do() {
        let mut against = pressed();
        against.look(&[[0.0; 3]; 3]);
        let (free, mut held) = (vec![[0.1, -0.2, -0.3]; 3], vec![[1.0; 3]; 3]);
        against.held_back(&free, &mut held);
        // u = free - C held, held = springs u.
        let moved: Vec<[f64; 3]> = (free.iter().zip(&held))
            .map(|(free, held)| [0, 1, 2].map(|axis| free[axis] - 0.5 * held[axis]))
            .collect();
        let mut sprung = vec![[0.0; 3]; 3];
        for &(one, normal) in &against.pressing {
            let place = &against.places[one];
            place.add(
                place.firmness * normal.dot(place.mean(&moved)) * normal,
                &mut sprung,
            );
        }
        assert_eq!(against.pressing.len(), 2);
        for (held, sprung) in held.as_flattened().iter().zip(sprung.as_flattened()) {
            assert!((held - sprung).abs() < 1e-12);
        }
    }
}
