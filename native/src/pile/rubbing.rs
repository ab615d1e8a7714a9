//! Forces of contacts: pushes, and friction within its limits.
//!
//! Pushes for given forces aside are found exactly, forces aside for given pushes by projected
//! Gauss-Seidel, and the two take turns (P. D. Panagiotopoulos, 1975), as in the tick.

use glam::DVec2;

use super::system::System;
use crate::algebra::cholesky::dot;
use crate::tool::complementarity::Complementarity;
use crate::tool::friction::nearer;

/// Turns of pushes and forces aside, and sweeps of the latter in each.
const MOST_TURNS: usize = 6;
const MOST_SWEEPS: usize = 8;
/// Forces that change by less than this share of the largest have been found.
const FOUND: f64 = 1e-6;
/// Work of one solve for the pushes: all that it takes.
const MOST_WORK: usize = usize::MAX / 4;

/// Forces along the directions of a system, beginning with these; `friction` is each contact's
/// coefficient, zero where nothing sticks yet.
pub(super) fn rub(
    system: &System,
    problem: &mut Complementarity,
    forces: &mut [f64],
    friction: &[f64],
) {
    let count = friction.len();
    problem.begin(count);
    for i in 0..count {
        let row = system.row(3 * i);
        for j in 0..=i {
            problem.set(i, j, row[3 * j]);
        }
        problem.forces[i] = forces[3 * i];
    }
    let rubs = friction.iter().any(|&coefficient| coefficient > 0.0);
    for _ in 0..MOST_TURNS {
        let by_push = push(system, problem, forces, count);
        if !rubs {
            return;
        }
        let largest = forces
            .iter()
            .fold(0.0_f64, |most, force| most.max(force.abs()));
        let mut by_sweeps = 0.0_f64;
        for _ in 0..MOST_SWEEPS {
            let change = sweep(system, forces, friction);
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
fn push(system: &System, problem: &mut Complementarity, forces: &mut [f64], count: usize) -> f64 {
    for i in 0..count {
        forces[3 * i] = 0.0;
    }
    for i in 0..count {
        problem.gaps[i] = system.at_rest[3 * i] + dot(system.row(3 * i), forces);
    }
    let before: Vec<f64> = problem.forces[..count].to_vec();
    problem.solve(MOST_WORK);
    let mut most = 0.0_f64;
    for (i, before) in before.iter().enumerate() {
        forces[3 * i] = problem.forces[i];
        most = most.max((problem.forces[i] - before).abs());
    }
    most
}

/// Each force aside in turn brings its point back to where it stuck, or as near as it may; by how much
/// one changed at most, N.
fn sweep(system: &System, forces: &mut [f64], friction: &[f64]) -> f64 {
    let mut most = 0.0_f64;
    for (k, coefficient) in friction.iter().enumerate() {
        let [x, y] = [3 * k + 1, 3 * k + 2];
        let limit = coefficient * forces[3 * k];
        let last = DVec2::new(forces[x], forces[y]);
        let force = if limit > 0.0 {
            let [along_x, along_y] = [system.row(x), system.row(y)];
            let slip = DVec2::new(
                system.at_rest[x] + dot(along_x, forces),
                system.at_rest[y] + dot(along_y, forces),
            );
            nearer(last, slip, [along_x[x], along_x[y], along_y[y]], limit)
        } else {
            DVec2::ZERO
        };
        (forces[x], forces[y]) = (force.x, force.y);
        most = most.max((force - last).abs().max_element());
    }
    most
}
