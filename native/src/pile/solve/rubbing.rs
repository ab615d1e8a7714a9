//! Forces of contacts: pushes, and friction within its limits.
//!
//! Pushes for given forces aside are found exactly, forces aside for given pushes by projected
//! Gauss-Seidel, and the two take turns (P. D. Panagiotopoulos, 1975), as in the tick.

use glam::DVec2;

use super::pace::Pace;
use super::system::System;
use crate::algebra::cholesky::dot_within;
use crate::algebra::wide::{add, widely};
use crate::tool::complementarity::Complementarity;
use crate::tool::friction::nearer;

/// Forces that change by less than this share of the largest have been found.
const FOUND: f64 = 1e-6;

/// How contacts rub.
pub(super) struct Rubbed<'a> {
    /// Coefficients of those that do.
    pub friction: &'a [f64],
    pub pace: Pace,
}

/// Forces along the unknowns of a system, beginning with these. `slips` is memory.
pub(super) fn rub(
    system: &System,
    problem: &mut Complementarity,
    forces: &mut [f64],
    &Rubbed { friction, pace }: &Rubbed<'_>,
    slips: &mut Vec<f64>,
) {
    let count = system.directions.len();
    // Of the same matrix there is a factor.
    let own = |i: usize| system.row(i)[i] + system.springs[i];
    if !(system.is_kept && (0..count).all(|i| problem.own(i) == own(i))) {
        problem.begin(count);
        for i in 0..count {
            let row = problem.row_mut(i);
            row.copy_from_slice(&system.row(i)[..count]);
            row[i] = own(i);
        }
    }
    problem.forces[..count].copy_from_slice(&forces[..count]);
    for _ in 0..pace.turns {
        let by_push = push(system, problem, forces, (count, pace.work));
        if system.rubs.is_empty() {
            return;
        }
        let largest = (forces.iter()).fold(0.0_f64, |most, force| most.max(force.abs()));
        slips.resize(forces.len() - count, 0.0);
        begin_slips(system, &forces[..count], slips);
        let (pushes, asides) = forces.split_at_mut(count);
        let mut by_sweeps = 0.0_f64;
        for _ in 0..pace.sweeps {
            let change = sweep(system, pushes, asides, friction, slips);
            by_sweeps = by_sweeps.max(change);
            if change <= FOUND * largest {
                break;
            }
        }
        if by_push.max(by_sweeps) <= FOUND * largest {
            return;
        }
    }
}

/// Finds the pushes under the forces aside; by how much one changed at most, N.
fn push(
    system: &System,
    problem: &mut Complementarity,
    forces: &mut [f64],
    (count, work): (usize, usize),
) -> f64 {
    problem.gaps[..count].copy_from_slice(&system.at_rest[..count]);
    for (aside, &force) in forces.iter().enumerate().skip(count) {
        if force != 0.0 {
            add(force, &system.row(aside)[..count], &mut problem.gaps);
        }
    }
    problem.solve(work);
    let mut most = 0.0_f64;
    for (force, &found) in forces.iter_mut().zip(&problem.forces[..count]) {
        most = most.max((found - *force).abs());
        *force = found;
    }
    most
}

widely! {
    /// How far contacts are from where they stuck, by the pushes alone.
    fn begin_slips(system: &System, pushes: &[f64], slips: &mut [f64]) {
        for (k, slip) in slips.iter_mut().enumerate() {
            let number = pushes.len() + k;
            let row = &system.row(number)[..pushes.len()];
            *slip = system.at_rest[number] + dot_within::<FUSED>(row, pushes);
        }
    }
}

widely! {
    /// Each force aside in turn brings its point back to where it stuck, or as near as it may; by how much
    /// one changed at most, N.
    fn sweep(
        system: &System,
        pushes: &[f64],
        asides: &mut [f64],
        friction: &[f64],
        slips: &[f64],
    ) -> f64 {
        let (mut most, count) = (0.0_f64, pushes.len());
        for (k, (coefficient, &contact)) in friction.iter().zip(&system.rubs).enumerate() {
            let [x, y] = [2 * k, 2 * k + 1];
            let limit = coefficient * pushes[contact];
            let last = DVec2::new(asides[x], asides[y]);
            let force = if limit > 0.0 {
                let along = [x, y].map(|k: usize| &system.row(count + k)[count..]);
                let slip = DVec2::new(
                    slips[x] + dot_within::<FUSED>(along[0], asides),
                    slips[y] + dot_within::<FUSED>(along[1], asides),
                );
                nearer(last, slip, [along[0][x], along[0][y], along[1][y]], limit)
            } else {
                DVec2::ZERO
            };
            (asides[x], asides[y]) = (force.x, force.y);
            most = most.max((force - last).abs().max_element());
        }
        most
    }
}
