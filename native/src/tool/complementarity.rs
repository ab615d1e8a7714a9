//! The complementarity problem of a contact that may only push, in bounded time.
//!
//! Forces f >= 0 with gaps w = A f + g >= 0 and f_i w_i = 0 for a symmetric positive definite A: the
//! least of the energy 1/2 f A f + g f over f >= 0. An exact solve on the points that carry force and
//! a sweep of projected Gauss-Seidel take turns (Moré and Toraldo 1991). The energy falls in every
//! step, so nothing cycles, and where the bound on the work ends it early the forces are still a
//! push, nearer the solution than at the start. The factor of the exact solves is kept up to date while
//! points come and go.

mod face;
pub(crate) mod stiffness;

use crate::algebra::cholesky::{Factor, dot, dot_within};
use crate::algebra::wide::widely;
use crate::algebra::{MOST_POINTS, ROW, room};

/// Rounds of exact solve and sweep. From the tick before one or two are enough.
const MOST_ROUNDS: usize = 12;
/// Halvings of a step that would raise the energy, before the last one that cannot.
const MOST_HALVINGS: usize = 4;
/// Of what rounding leaves in the sum A f + g, this many units count as zero.
const ROUNDING_UNITS: f64 = 64.0;
/// More points than the mesh has freedom beneath them make A singular: its diagonal grows by the first
/// share then, which shares the force out evenly. Two near fields that are too firm together, by the
/// rims of thin parts, make it indefinite: it grows until it is not.
const SHIFTS: [f64; 5] = [1e-9, 1e-5, 1e-3, 1e-2, 1e-1];

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Solved {
    /// The conditions hold to rounding; else the bound on the work ended it.
    pub exact: bool,
    /// Rounds of exact solve and sweep.
    pub rounds: usize,
}

/// A problem of up to [`MOST_POINTS`] unknowns and the memory to solve it in.
#[derive(Debug, Clone)]
pub struct Complementarity {
    count: usize,
    /// A, row by row, [`ROW`] numbers apart.
    matrix: Vec<f64>,
    /// g: negative where the points overlap the tool while no force acts.
    pub gaps: Vec<f64>,
    /// f: where to begin, and then the solution.
    pub forces: Vec<f64>,
    opened: Vec<f64>,
    factor: Factor,
    /// The unknowns that the factor is of, in its order, and whether each is one.
    face: Vec<usize>,
    is_on_face: Vec<bool>,
    exact: Vec<f64>,
    tried: Vec<f64>,
    work: usize,
    decompositions: usize,
    /// How often the face has changed.
    faces: usize,
    most_work: usize,
    /// By this share the diagonal has grown, since A was found singular.
    shift: f64,
    /// The factor is that of A on the face.
    is_decomposed: bool,
    /// Square roots of the diagonal.
    scale: Vec<f64>,
}

impl Default for Complementarity {
    fn default() -> Self {
        Self {
            count: 0,
            matrix: room(MOST_POINTS * ROW),
            gaps: vec![0.0; MOST_POINTS],
            forces: vec![0.0; MOST_POINTS],
            opened: vec![0.0; MOST_POINTS],
            factor: Factor::default(),
            face: Vec::with_capacity(MOST_POINTS),
            is_on_face: vec![false; MOST_POINTS],
            exact: vec![0.0; MOST_POINTS],
            tried: vec![0.0; MOST_POINTS],
            work: 0,
            decompositions: 0,
            faces: 0,
            most_work: 0,
            shift: 0.0,
            is_decomposed: false,
            scale: vec![0.0; MOST_POINTS],
        }
    }
}

impl Complementarity {
    /// Begins a problem of `count` unknowns: rows of the matrix and gaps are to be set.
    pub fn begin(&mut self, count: usize) {
        debug_assert!(count <= MOST_POINTS, "{count}");
        self.count = count;
        (self.is_decomposed, self.shift) = (false, 0.0);
    }

    /// Row `i` of A, of which the first numbers count.
    #[inline]
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.matrix[i * ROW..][..self.count]
    }

    /// A_ij and A_ji at once.
    #[inline]
    pub fn set(&mut self, i: usize, j: usize, value: f64) {
        self.matrix[i * ROW + j] = value;
        self.matrix[j * ROW + i] = value;
    }

    #[inline]
    fn row(&self, i: usize) -> &[f64] {
        &self.matrix[i * ROW..][..self.count]
    }

    /// Solves from the forces that are there; what is negative or no number counts as zero. Solved
    /// again for other gaps, it goes on with the factor that it has.
    ///
    /// Of multiplications it takes about as many as told at most, or one exact solve and one sweep.
    pub fn solve(&mut self, most_work: usize) -> Solved {
        let count = self.count;
        (self.work, self.most_work) = (0, most_work);
        self.decompositions = 0;
        for i in 0..count {
            self.scale[i] = self.row(i)[i].sqrt();
        }
        for force in &mut self.forces[..count] {
            *force = if *force > 0.0 { *force } else { 0.0 };
        }
        self.open();
        // A start of more energy than nothing at all would be worse than none.
        if self.energy_of_start() > 0.0 {
            self.forces[..count].fill(0.0);
        }
        for rounds in 1.. {
            let had_work = self.least_on_face();
            self.open();
            if self.is_solved() {
                return Solved {
                    exact: true,
                    rounds,
                };
            }
            self.sweep();
            self.work += 2 * count * count;
            if !had_work || self.work > self.most_work || rounds == MOST_ROUNDS {
                return Solved {
                    exact: false,
                    rounds,
                };
            }
        }
        unreachable!("the last round returns");
    }

    /// Multiplications that the last solve took, about.
    #[inline]
    pub fn work(&self) -> usize {
        self.work
    }

    /// A_ii.
    #[inline]
    pub fn own(&self, i: usize) -> f64 {
        self.row(i)[i]
    }

    /// How far an unknown gives way beyond its row of A, by the growth of the diagonal, per force.
    #[inline]
    pub fn growth(&self, i: usize) -> f64 {
        self.shift * self.row(i)[i]
    }

    /// How often other unknowns came to carry force so far.
    #[inline]
    pub fn faces(&self) -> usize {
        self.faces
    }

    /// Decompositions that the last solve took.
    #[inline]
    pub fn decompositions(&self) -> usize {
        self.decompositions
    }

    /// 1/2 f A f of some forces.
    pub fn energy_of(&self, forces: &[f64]) -> f64 {
        let carry = (0..self.count).filter(|&i| forces[i] > 0.0);
        carry
            .map(|i| 0.5 * forces[i] * dot(self.row(i), forces))
            .sum()
    }

    /// A f + g.
    fn open(&mut self) {
        let (matrix, gaps, forces) = (&self.matrix, &self.gaps, &self.forces[..self.count]);
        let opened = &mut self.opened[..self.count];
        open(matrix, gaps, forces, opened);
    }

    /// 1/2 f (A f + g) + 1/2 f g, once opened.
    fn energy_of_start(&self) -> f64 {
        let n = self.count;
        0.5 * (dot(&self.forces[..n], &self.opened[..n]) + dot(&self.forces[..n], &self.gaps[..n]))
    }

    fn is_solved(&self) -> bool {
        let share = (4.0 * self.shift).max(ROUNDING_UNITS * f64::EPSILON);
        // |a_ij| <= sqrt(a_ii a_jj): what rounding the sums can have had.
        let total = dot(&self.scale[..self.count], &self.forces[..self.count]);
        (0..self.count).all(|i| {
            let (force, gap) = (self.forces[i], self.opened[i]);
            let unit = share * (self.scale[i] * total + self.gaps[i].abs());
            gap >= -unit && (force <= 0.0 || gap <= unit)
        })
    }

    /// One sweep of projected Gauss-Seidel: each force in turn as its own gap demands.
    fn sweep(&mut self) {
        let (matrix, gaps) = (&self.matrix, &self.gaps);
        let forces = &mut self.forces[..self.count];
        sweep(matrix, gaps, forces);
    }

    /// Least energy among forces on the points that carry any now, dropping what would pull. False
    /// when the bound on the work ended it.
    fn least_on_face(&mut self) -> bool {
        loop {
            let size = self.forces[..self.count]
                .iter()
                .filter(|&&f| f > 0.0)
                .count();
            if size == 0 {
                return true;
            }
            let cost = self.cost_of_face(size) + size * size;
            if self.work > 0 && self.work + cost > self.most_work {
                return false;
            }
            self.work += cost;
            if !self.take_face() {
                // The sweeps alone, which need the diagonal only.
                return true;
            }
            for (exact, &i) in self.exact.iter_mut().zip(&self.face) {
                *exact = -self.gaps[i];
            }
            self.factor.solve(&mut self.exact[..size]);
            if self.exact[..size].iter().all(|&force| force > 0.0) {
                for (&i, &force) in self.face.iter().zip(&self.exact) {
                    self.forces[i] = force;
                }
                return true;
            }
            self.step_towards_exact();
        }
    }

    /// The unknowns that carry force, and the factor of A on them; after [`Self::take_face`].
    pub fn on_face(&self) -> (&[usize], &Factor) {
        (&self.face, &self.factor)
    }
}

widely! {
    /// 1/2 f A f + g f of forces that are zero off some unknowns.
    fn energy(matrix: &[f64], gaps: &[f64], face: &[usize], forces: &[f64]) -> f64 {
        let mut sum = 0.0;
        for &i in face {
            let row = &matrix[i * ROW..][..forces.len()];
            sum += forces[i] * (0.5 * dot_within::<FUSED>(row, forces) + gaps[i]);
        }
        sum
    }
}

widely! {
    /// Each force in turn as its own gap demands.
    fn sweep(matrix: &[f64], gaps: &[f64], forces: &mut [f64]) {
        for i in 0..forces.len() {
            let row = &matrix[i * ROW..][..forces.len()];
            let gap = dot_within::<FUSED>(row, forces) + gaps[i];
            forces[i] = (forces[i] - gap / row[i]).max(0.0);
        }
    }
}

widely! {
    /// A f + g.
    fn open(matrix: &[f64], gaps: &[f64], forces: &[f64], opened: &mut [f64]) {
        for i in 0..opened.len() {
            let row = &matrix[i * ROW..][..forces.len()];
            opened[i] = dot_within::<FUSED>(row, forces) + gaps[i];
        }
    }
}
