//! Forces that give contact points their displacements while each may only push.
//!
//! The least of 1/2 F.C F - F.u with every F_p in a cone about its push: a strictly convex problem.
//! Solved directly where all forces are in their cones, else in rounds of a semismooth Newton step
//! and a sweep of projected block Gauss-Seidel that never raises the energy, from the forces of the
//! tick before.

use glam::{DMat3, DVec3};

use crate::algebra::small_matrix::{MOST_ROWS, SmallMatrix};
pub use crate::contact::cone::Cone;
use crate::contact::touch::inverse_of_definite;

/// Fingers on one body at most.
pub const MAX_FINGERS: usize = MOST_ROWS / 3;
/// Forces are taken when they miss their conditions by this share of the largest one.
const CONVERGED: f64 = 1e-12;
/// Rounds in one tick; from the tick before one to three are enough, and any may be the last.
pub const TICK_ROUNDS: usize = 10;

/// C_pq, by finger.
pub type Blocks = [[DMat3; MAX_FINGERS]; MAX_FINGERS];
/// A vector for each finger.
pub type Vectors = [DVec3; MAX_FINGERS];

/// A third of the trace.
#[inline]
pub fn mean(matrix: &DMat3) -> f64 {
    (matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z) / 3.0
}

/// Which fingers take part, and where their blocks stand in one matrix.
#[derive(Debug, Clone, Copy)]
pub struct Members {
    numbers: [usize; MAX_FINGERS],
    /// How many.
    pub count: usize,
}

impl Members {
    /// Those that are there.
    pub fn of<T>(some: &[Option<T>; MAX_FINGERS]) -> Self {
        let mut members = Self {
            numbers: [0; MAX_FINGERS],
            count: 0,
        };
        for (number, _) in some.iter().enumerate().filter(|(_, one)| one.is_some()) {
            members.numbers[members.count] = number;
            members.count += 1;
        }
        members
    }

    /// Their numbers.
    pub fn numbers(&self) -> impl Iterator<Item = usize> + use<> {
        self.numbers.into_iter().take(self.count)
    }

    fn placed(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        (0..self.count).map(|k| 3 * k).zip(self.numbers())
    }

    /// One matrix of a block for each pair.
    fn matrix(&self, block: impl Fn(usize, usize) -> DMat3) -> SmallMatrix {
        let mut matrix = SmallMatrix::zero(3 * self.count);
        for (row, p) in self.placed() {
            for (column, q) in self.placed() {
                matrix.put(row, column, &block(p, q));
            }
        }
        matrix
    }

    fn column(&self, vector: impl Fn(usize) -> DVec3) -> [f64; MOST_ROWS] {
        let mut column = [0.0; MOST_ROWS];
        for (row, p) in self.placed() {
            column[row..row + 3].copy_from_slice(&vector(p).to_array());
        }
        column
    }

    fn vectors(&self, column: &[f64; MOST_ROWS]) -> Vectors {
        let mut vectors = [DVec3::ZERO; MAX_FINGERS];
        for (row, p) in self.placed() {
            vectors[p] = DVec3::from_slice(&column[row..]);
        }
        vectors
    }

    /// The diagonal blocks of the inverse: how stiff each is while the others are held.
    pub fn held(&self, compliance: &Blocks) -> Option<[DMat3; MAX_FINGERS]> {
        let inverse = self.matrix(|p, q| compliance[p][q]).factored()?.inverse();
        let mut held = [DMat3::ZERO; MAX_FINGERS];
        for (row, p) in self.placed() {
            held[p] = inverse.block(row, row);
        }
        Some(held)
    }
}

/// Forces for C that has been made distinct; `None` for one that is not definite.
pub fn solve_distinct(
    compliance: &Blocks,
    asked: &Vectors,
    cones: &[Cone; MAX_FINGERS],
    members: &Members,
    before: &Vectors,
) -> Option<Vectors> {
    let mut column = members.column(|p| asked[p]);
    members
        .matrix(|p, q| compliance[p][q])
        .factored()?
        .solve(&mut column);
    let direct = members.vectors(&column);
    let pressing = Pressing {
        compliance,
        asked,
        cones,
        members,
    };
    if pressing.projected(&direct) == direct {
        Some(direct)
    } else {
        pressing.in_rounds(before)
    }
}

/// The problem.
struct Pressing<'a> {
    compliance: &'a Blocks,
    asked: &'a Vectors,
    cones: &'a [Cone; MAX_FINGERS],
    members: &'a Members,
}

impl Pressing<'_> {
    fn each(&self, vector: impl Fn(usize) -> DVec3) -> Vectors {
        let mut vectors = [DVec3::ZERO; MAX_FINGERS];
        for p in self.members.numbers() {
            vectors[p] = vector(p);
        }
        vectors
    }

    /// What a contact point lacks to the displacement asked for.
    fn short(&self, forces: &Vectors, p: usize) -> DVec3 {
        let moved = self
            .members
            .numbers()
            .map(|q| self.compliance[p][q] * forces[q]);
        self.asked[p] - moved.sum::<DVec3>()
    }

    fn energy(&self, forces: &Vectors) -> f64 {
        let part = |p: usize| forces[p].dot(self.short(forces, p) + self.asked[p]);
        -0.5 * self.members.numbers().map(part).sum::<f64>()
    }

    fn projected(&self, forces: &Vectors) -> Vectors {
        self.each(|p| self.cones[p].nearest(forces[p]))
    }

    /// Newton per metre, about the firmness of a finger alone.
    fn step(&self, p: usize) -> f64 {
        1.0 / mean(&self.compliance[p][p])
    }

    fn ahead(&self, forces: &Vectors) -> Vectors {
        self.each(|p| forces[p] + self.short(forces, p) * self.step(p))
    }

    /// The largest part of F - P(F + t (u - C F)), zero for the answer alone.
    fn missing(&self, forces: &Vectors) -> f64 {
        let there = self.projected(&self.ahead(forces));
        largest(&self.each(|p| forces[p] - there[p]))
    }

    fn in_rounds(&self, before: &Vectors) -> Option<Vectors> {
        let mut forces = self.projected(before);
        // A first step that leads away would be taken back by sweeps and taken again in the next tick.
        let mut least = 2.0 * self.missing(&forces);
        for _ in 0..TICK_ROUNDS {
            let further = self.newton_step(&forces)?;
            let missing = self.missing(&further);
            if missing <= CONVERGED * largest(&further) {
                return Some(further);
            }
            if missing <= 0.5 * least || self.energy(&further) < self.energy(&forces) {
                (forces, least) = (further, least.min(missing));
            }
            self.sweep(&mut forces)?;
        }
        Some(forces)
    }

    /// For F = P(F + t (u - C F)): (1 - J + J t C) F = J t u with the projection's derivative J,
    /// then projected onto the cones.
    fn newton_step(&self, forces: &Vectors) -> Option<Vectors> {
        let ahead = self.ahead(forces);
        let mut derivatives = [DMat3::ZERO; MAX_FINGERS];
        for p in self.members.numbers() {
            derivatives[p] = self.cones[p].derivative(ahead[p]);
        }
        let system = self.members.matrix(|p, q| {
            let coupled = derivatives[p] * self.compliance[p][q] * self.step(p);
            if p == q {
                DMat3::IDENTITY - derivatives[p] + coupled
            } else {
                coupled
            }
        });
        let mut column = self
            .members
            .column(|p| derivatives[p] * self.asked[p] * self.step(p));
        system.eliminate(&mut column)?;
        Some(self.projected(&self.members.vectors(&column)))
    }

    /// Once over all fingers: each takes the force that meets its displacement given the others',
    /// where its cone has it; otherwise a step down the gradient, short enough to lead down.
    fn sweep(&self, forces: &mut Vectors) -> Option<()> {
        for p in self.members.numbers() {
            let own = &self.compliance[p][p];
            let short = self.short(forces, p);
            let wanted = forces[p] + inverse_of_definite(own)? * short;
            forces[p] = if self.cones[p].nearest(wanted) == wanted {
                wanted
            } else {
                let step = 1.0 / (3.0 * mean(own));
                self.cones[p].nearest(forces[p] + short * step)
            };
        }
        Some(())
    }
}

fn largest(vectors: &Vectors) -> f64 {
    let sizes = vectors.iter().map(|v| v.abs().max_element());
    sizes.fold(0.0, f64::max)
}
