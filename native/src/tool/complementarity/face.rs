//! The unknowns that carry force, and the factor of the matrix on them, kept up to date.

use super::{Complementarity, MOST_HALVINGS, SHIFTS, energy};
use crate::algebra::ROW;

impl Complementarity {
    /// Multiplications that a factor takes on the `size` unknowns that carry force: from the one that
    /// is there, or as if there were none, whichever is less.
    pub(super) fn cost_of_face(&self, size: usize) -> usize {
        let anew = size * size * size / 6;
        if self.is_decomposed {
            self.cost_of_changes().min(anew)
        } else {
            anew
        }
    }

    /// Multiplications that it takes to bring the factor up to date.
    fn cost_of_changes(&self) -> usize {
        let size = self.face.len();
        let goes = |&(_, &i): &(usize, &usize)| self.forces[i] <= 0.0;
        let gone = self.face.iter().enumerate().filter(goes);
        let gone: usize = gone.map(|(k, _)| 2 * (size - k) * (size - k)).sum();
        let comes = |&i: &usize| self.forces[i] > 0.0 && !self.is_on_face[i];
        gone + (0..self.count).filter(comes).count() * size * size / 2
    }

    /// Brings face and factor to the unknowns that carry force; false where A is not even
    /// semidefinite on them.
    pub fn take_face(&mut self) -> bool {
        if self.is_decomposed {
            let size = self.forces[..self.count]
                .iter()
                .filter(|&&f| f > 0.0)
                .count();
            let is_less = self.cost_of_changes() <= size * size * size / 6;
            self.is_decomposed = is_less && self.change_face();
        }
        if !self.is_decomposed {
            self.is_decomposed = self.decompose_face();
        }
        self.is_decomposed
    }

    /// Takes unknowns out of the factor and others in; false where A is singular with them.
    fn change_face(&mut self) -> bool {
        for k in (0..self.face.len()).rev() {
            if self.forces[self.face[k]] <= 0.0 {
                self.factor.remove(k);
                self.is_on_face[self.face.remove(k)] = false;
                self.faces += 1;
            }
        }
        for i in 0..self.count {
            if self.forces[i] > 0.0 && !self.is_on_face[i] {
                self.put_row(self.face.len(), i);
                if !self.factor.append() {
                    return false;
                }
                self.face.push(i);
                self.is_on_face[i] = true;
                self.faces += 1;
            }
        }
        true
    }

    /// The factor of A on the unknowns that carry force, anew, shifted where that is singular; false
    /// where that does not help.
    fn decompose_face(&mut self) -> bool {
        self.face.clear();
        self.faces += 1;
        for i in 0..self.count {
            self.is_on_face[i] = self.forces[i] > 0.0;
            if self.is_on_face[i] {
                self.face.push(i);
            }
        }
        loop {
            for place in 0..self.face.len() {
                self.put_row(place, self.face[place]);
            }
            self.decompositions += 1;
            if self.factor.decompose(self.face.len()) {
                return true;
            }
            let Some(&more) = SHIFTS.iter().find(|&&shift| shift > self.shift) else {
                return false;
            };
            self.shift = more;
        }
    }

    /// An unknown's row of A on the face before it, for the factor.
    fn put_row(&mut self, place: usize, i: usize) {
        let growth = 1.0 + self.shift;
        let from = &self.matrix[i * ROW..];
        let to = self.factor.row_mut(place);
        for (entry, &j) in to.iter_mut().zip(&self.face[..place]) {
            *entry = from[j];
        }
        to[place] = from[i] * growth;
    }

    /// From the forces towards the exact ones, clipped at zero; at least one becomes zero.
    pub(super) fn step_towards_exact(&mut self) {
        let energy = self.energy_on_face(&self.forces);
        self.work += self.face.len() * self.count;
        self.tried[..self.count].fill(0.0);
        let mut share = 1.0;
        for _ in 0..MOST_HALVINGS {
            let mut some_zero = false;
            for (&i, exact) in self.face.iter().zip(&self.exact) {
                let here = self.forces[i];
                self.tried[i] = (here + share * (exact - here)).max(0.0);
                some_zero |= self.tried[i] == 0.0;
            }
            self.work += self.face.len() * self.count;
            if some_zero && self.energy_on_face(&self.tried) < energy {
                self.forces[..self.count].copy_from_slice(&self.tried[..self.count]);
                return;
            }
            share *= 0.5;
        }
        // As far as the first force that becomes zero: nothing is clipped, so the energy falls.
        let (mut first, mut share) = (0, f64::INFINITY);
        for (&i, exact) in self.face.iter().zip(&self.exact) {
            let here = self.forces[i];
            if *exact <= 0.0 && here / (here - exact) < share {
                (first, share) = (i, here / (here - exact));
            }
        }
        for (&i, exact) in self.face.iter().zip(&self.exact) {
            let here = self.forces[i];
            self.forces[i] = (here + share * (exact - here)).max(0.0);
        }
        self.forces[first] = 0.0;
    }

    /// 1/2 f A f + g f of forces that are zero off the face.
    fn energy_on_face(&self, forces: &[f64]) -> f64 {
        let forces = &forces[..self.count];
        energy(&self.matrix, &self.gaps, &self.face, forces)
    }
}
