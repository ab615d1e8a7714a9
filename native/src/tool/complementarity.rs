//! The complementarity problem of a contact that may only push, in bounded time.
//!
//! Forces f >= 0 with gaps w = A f + g >= 0 and f_i w_i = 0 for a symmetric positive definite A: the
//! least of the energy 1/2 f A f + g f over f >= 0. An exact solve on the points that carry force and
//! a sweep of projected Gauss-Seidel take turns (Moré and Toraldo 1991). The energy falls in every
//! step, so nothing cycles, and where the bound on the work ends it early the forces are still a
//! push, nearer the solution than at the start. Readable reference: `core/complementarity.py`.

use super::cholesky::{Factor, dot};
use super::wide::widely;
use super::{MOST_POINTS, room};

/// Rounds of exact solve and sweep. From the tick before one or two are enough.
const MOST_ROUNDS: usize = 12;
/// Halvings of a step that would raise the energy, before the last one that cannot.
const MOST_HALVINGS: usize = 4;
/// Of what rounding leaves in the sum A f + g, this many units count as zero.
const ROUNDING_UNITS: f64 = 64.0;
/// More points than the mesh has freedom beneath them make A singular: its diagonal grows by this
/// share then, which shares the force out evenly.
const SHIFT: f64 = 1e-9;

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
    /// A, row by row, [`MOST_POINTS`] numbers apart.
    matrix: Vec<f64>,
    /// g: negative where the points overlap the tool while no force acts.
    pub gaps: Vec<f64>,
    /// f: where to begin, and then the solution.
    pub forces: Vec<f64>,
    opened: Vec<f64>,
    factor: Factor,
    /// The unknowns that carry force, and those numbers by themselves.
    face: Vec<usize>,
    exact: Vec<f64>,
    tried: Vec<f64>,
    work: usize,
    most_work: usize,
    /// A was found singular in this solve.
    is_shifted: bool,
    /// The factor is that of A on the unknowns that carry force now.
    is_fresh: bool,
    /// Square roots of the diagonal.
    scale: Vec<f64>,
}

impl Default for Complementarity {
    fn default() -> Self {
        Self {
            count: 0,
            matrix: room(MOST_POINTS * MOST_POINTS),
            gaps: vec![0.0; MOST_POINTS],
            forces: vec![0.0; MOST_POINTS],
            opened: vec![0.0; MOST_POINTS],
            factor: Factor::default(),
            face: Vec::with_capacity(MOST_POINTS),
            exact: vec![0.0; MOST_POINTS],
            tried: vec![0.0; MOST_POINTS],
            work: 0,
            most_work: 0,
            is_shifted: false,
            is_fresh: false,
            scale: vec![0.0; MOST_POINTS],
        }
    }
}

impl Complementarity {
    /// Begins a problem of `count` unknowns: rows of the matrix and gaps are to be set.
    pub fn begin(&mut self, count: usize) {
        debug_assert!(count <= MOST_POINTS, "{count}");
        self.count = count;
        self.is_fresh = false;
    }

    /// Row `i` of A, of which the first numbers count.
    #[inline]
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.matrix[i * MOST_POINTS..][..self.count]
    }

    /// A_ij and A_ji at once.
    #[inline]
    pub fn set(&mut self, i: usize, j: usize, value: f64) {
        self.matrix[i * MOST_POINTS + j] = value;
        self.matrix[j * MOST_POINTS + i] = value;
    }

    #[inline]
    fn row(&self, i: usize) -> &[f64] {
        &self.matrix[i * MOST_POINTS..][..self.count]
    }

    /// Solves from the forces that are there; what is negative or no number counts as zero.
    ///
    /// Of multiplications it takes about as many as told at most, or one exact solve and one sweep.
    pub fn solve(&mut self, most_work: usize) -> Solved {
        let count = self.count;
        (self.work, self.most_work) = (0, most_work);
        self.is_shifted = false;
        self.is_fresh = false;
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

    /// A f + g.
    fn open(&mut self) {
        let (matrix, gaps, forces) = (&self.matrix, &self.gaps, &self.forces[..self.count]);
        let opened = &mut self.opened[..self.count];
        widely!(open(matrix, gaps, forces, opened));
    }

    /// 1/2 f (A f + g) + 1/2 f g, once opened.
    fn energy_of_start(&self) -> f64 {
        let n = self.count;
        0.5 * (dot(&self.forces[..n], &self.opened[..n]) + dot(&self.forces[..n], &self.gaps[..n]))
    }

    fn is_solved(&self) -> bool {
        let share = if self.is_shifted {
            4.0 * SHIFT
        } else {
            ROUNDING_UNITS * f64::EPSILON
        };
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
        self.is_fresh = false;
        for i in 0..self.count {
            let row = self.row(i);
            let gap = dot(row, &self.forces[..self.count]) + self.gaps[i];
            let own = row[i];
            self.forces[i] = (self.forces[i] - gap / own).max(0.0);
        }
    }

    /// Least energy among forces on the points that carry any now, dropping what would pull. False
    /// when the bound on the work ended it.
    fn least_on_face(&mut self) -> bool {
        loop {
            self.face.clear();
            self.face
                .extend((0..self.count).filter(|&i| self.forces[i] > 0.0));
            let size = self.face.len();
            if size == 0 {
                return true;
            }
            if self.work > 0 && self.work + size * size * size / 6 > self.most_work {
                return false;
            }
            self.work += size * size * size / 6 + 1;
            if !self.decompose_face() {
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
                self.is_fresh = true;
                return true;
            }
            self.step_towards_exact();
        }
    }

    /// From the forces towards the exact ones, clipped at zero; at least one becomes zero.
    fn step_towards_exact(&mut self) {
        let size = self.face.len();
        self.tried[..size].copy_from_slice(&self.exact[..size]);
        let energy = self.energy_on_face(|k| self.forces[self.face[k]]);
        let mut share = 1.0;
        for _ in 0..MOST_HALVINGS {
            let mut some_zero = false;
            for k in 0..size {
                let here = self.forces[self.face[k]];
                self.tried[k] = (here + share * (self.exact[k] - here)).max(0.0);
                some_zero |= self.tried[k] == 0.0;
            }
            if some_zero && self.energy_on_face(|k| self.tried[k]) < energy {
                for (&i, &force) in self.face.iter().zip(&self.tried) {
                    self.forces[i] = force;
                }
                return;
            }
            share *= 0.5;
        }
        // As far as the first force that becomes zero: nothing is clipped, so the energy falls.
        let (mut first, mut share) = (0, f64::INFINITY);
        for k in 0..size {
            let here = self.forces[self.face[k]];
            if self.exact[k] <= 0.0 && here / (here - self.exact[k]) < share {
                (first, share) = (k, here / (here - self.exact[k]));
            }
        }
        for (k, &i) in self.face.iter().enumerate() {
            let here = self.forces[i];
            self.forces[i] = (here + share * (self.exact[k] - here)).max(0.0);
        }
        self.forces[self.face[first]] = 0.0;
    }

    fn energy_on_face(&self, force: impl Fn(usize) -> f64) -> f64 {
        let mut energy = 0.0;
        for (k, &i) in self.face.iter().enumerate() {
            let row = &self.matrix[i * MOST_POINTS..];
            let mut moved = 0.0;
            for (l, &j) in self.face[..k].iter().enumerate() {
                moved += row[j] * force(l);
            }
            let own = force(k);
            energy += own * (moved + 0.5 * row[i] * own + self.gaps[i]);
        }
        energy
    }

    /// The unknowns that carry force, and a factor of A on them; after a solve. `None` where A is
    /// not even semidefinite on them.
    pub fn factor_on_face(&mut self) -> Option<(&[usize], &Factor)> {
        if !self.is_fresh {
            self.face.clear();
            self.face
                .extend((0..self.count).filter(|&i| self.forces[i] > 0.0));
            self.is_fresh = self.decompose_face();
        }
        self.is_fresh.then_some((&self.face, &self.factor))
    }

    /// The factor of A on the face, shifted where that is singular; false where that does not help.
    fn decompose_face(&mut self) -> bool {
        for _ in 0..2 {
            let growth = if self.is_shifted { 1.0 + SHIFT } else { 1.0 };
            for (place, &i) in self.face.iter().enumerate() {
                let from = &self.matrix[i * MOST_POINTS..];
                let to = self.factor.row_mut(place);
                for (entry, &j) in to.iter_mut().zip(&self.face[..=place]) {
                    *entry = from[j];
                }
                to[place] *= growth;
            }
            if self.factor.decompose(self.face.len()) {
                return true;
            }
            if self.is_shifted {
                return false;
            }
            self.is_shifted = true;
        }
        false
    }
}

/// A f + g.
#[inline(always)]
fn open(matrix: &[f64], gaps: &[f64], forces: &[f64], opened: &mut [f64]) {
    let rows = matrix.chunks_exact(MOST_POINTS);
    for ((opened, gap), row) in opened.iter_mut().zip(gaps).zip(rows) {
        *opened = dot(&row[..forces.len()], forces) + gap;
    }
}
