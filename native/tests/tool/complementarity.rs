//! Forces that may only push: the conditions hold, from any start, on singular matrices too.

use crate::bodies::Dice;
use palpate_servo::algebra::MOST_POINTS;
use palpate_servo::algebra::cholesky::Factor;
use palpate_servo::tool::complementarity::Complementarity;

/// Work enough for any of these.
const PLENTY: usize = 100_000_000;

/// A = B B' + shift 1 of `rank` columns, and gaps of both signs.
fn problem(dice: &mut Dice, count: usize, rank: usize, shift: f64) -> (Vec<Vec<f64>>, Vec<f64>) {
    let columns: Vec<Vec<f64>> = (0..count)
        .map(|_| (0..rank).map(|_| dice.within(-0.3, 1.0)).collect())
        .collect();
    let product = |i: usize, j: usize| {
        let sum: f64 = columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum();
        sum + if i == j { shift } else { 0.0 }
    };
    let matrix = (0..count)
        .map(|i| (0..count).map(|j| product(i, j)).collect())
        .collect();
    let gaps = (0..count).map(|_| dice.within(-1.0, 0.5)).collect();
    (matrix, gaps)
}

fn load(solver: &mut Complementarity, matrix: &[Vec<f64>], gaps: &[f64]) {
    solver.begin(gaps.len());
    for (i, row) in matrix.iter().enumerate() {
        solver.row_mut(i).copy_from_slice(row);
    }
    solver.gaps[..gaps.len()].copy_from_slice(gaps);
}

/// The largest breach of f >= 0, A f + g >= 0, and one of both zero.
fn breach(matrix: &[Vec<f64>], gaps: &[f64], forces: &[f64]) -> f64 {
    let mut worst = 0.0_f64;
    for (i, row) in matrix.iter().enumerate() {
        let moved: f64 = row.iter().zip(forces).map(|(a, f)| a * f).sum();
        let gap = moved + gaps[i];
        worst = worst.max(-forces[i]).max(-gap);
        if forces[i] > 0.0 {
            worst = worst.max(gap);
        }
    }
    worst
}

fn energy(matrix: &[Vec<f64>], gaps: &[f64], forces: &[f64]) -> f64 {
    let moved = |row: &[f64]| row.iter().zip(forces).map(|(a, f)| a * f).sum::<f64>();
    (matrix.iter().zip(gaps).zip(forces))
        .map(|((row, gap), force)| force * (0.5 * moved(row) + gap))
        .sum()
}

#[test]
fn the_conditions_hold_from_any_start() {
    let dice = &mut Dice::new(3);
    let mut solver = Complementarity::default();
    for count in [1, 2, 3, 7, 12, 40, 97, MOST_POINTS] {
        for round in 0..6 {
            let (matrix, gaps) = problem(dice, count, count, 0.05);
            load(&mut solver, &matrix, &gaps);
            for force in &mut solver.forces[..count] {
                *force = match round {
                    0 => 0.0,
                    1 => f64::NAN,
                    _ => dice.within(-1.0, 1.0),
                };
            }
            let solved = solver.solve(PLENTY);
            let forces = &solver.forces[..count];
            assert!(solved.exact, "{count} {round}: {solved:?}");
            assert!(breach(&matrix, &gaps, forces) < 1e-10, "{count} {round}");
        }
    }
}

#[test]
fn a_warm_start_is_done_at_once() {
    let (matrix, gaps) = problem(&mut Dice::new(4), 60, 60, 0.05);
    let mut solver = Complementarity::default();
    load(&mut solver, &matrix, &gaps);
    solver.solve(PLENTY);
    let nudged: Vec<f64> = gaps.iter().map(|gap| gap * (1.0 + 1e-9)).collect();
    load(&mut solver, &matrix, &nudged);
    let solved = solver.solve(PLENTY);
    assert!(solved.exact && solved.rounds == 1, "{solved:?}");
}

#[test]
fn more_points_than_freedoms_share_the_force() {
    let dice = &mut Dice::new(5);
    let mut solver = Complementarity::default();
    for rank in [1, 3, 9, 30] {
        let (matrix, mut gaps) = problem(dice, 50, rank, 0.0);
        // Gaps that some displacement of so few freedoms opens.
        for (gap, row) in gaps.iter_mut().zip(&matrix) {
            *gap = -row.iter().sum::<f64>() / 50.0;
        }
        load(&mut solver, &matrix, &gaps);
        solver.forces.fill(0.0);
        let solved = solver.solve(PLENTY);
        let forces = &solver.forces[..50];
        let size = gaps.iter().fold(0.0_f64, |m, gap| m.max(gap.abs()));
        assert!(
            forces.iter().all(|&f| (0.0..1e3).contains(&f)),
            "{forces:?}"
        );
        assert!(breach(&matrix, &gaps, forces) < 1e-6 * size, "{solved:?}");
    }
}

#[test]
fn work_that_ends_early_never_raises_the_energy() {
    let dice = &mut Dice::new(6);
    let mut solver = Complementarity::default();
    for _ in 0..20 {
        // Hardly positive definite, much coupled: the hardest there is.
        let (matrix, gaps) = problem(dice, MOST_POINTS, 20, 1e-9);
        load(&mut solver, &matrix, &gaps);
        for force in &mut solver.forces {
            *force = dice.within(0.0, 1e-3);
        }
        let before = energy(&matrix, &gaps, &solver.forces).min(0.0);
        let solved = solver.solve(200_000);
        assert!(!solved.exact);
        assert!(solver.forces.iter().all(|&f| f >= 0.0 && f.is_finite()));
        let after = energy(&matrix, &gaps, &solver.forces);
        assert!(after <= before + 1e-9 * before.abs(), "{before} {after}");
    }
}

/// Puts the row of one unknown into a factor, behind those that are in it.
fn put(factor: &mut Factor, place: usize, matrix: &[Vec<f64>], kept: &[usize], i: usize) {
    let row = factor.row_mut(place);
    for (entry, &j) in row.iter_mut().zip(kept) {
        *entry = matrix[i][j];
    }
    row[place] = matrix[i][i];
}

#[test]
fn a_factor_of_any_size_solves_its_matrix() {
    let dice = &mut Dice::new(9);
    for count in [1, 2, 7, 8, 9, 15, 16, 17, 70, 207, 208, 301] {
        let (matrix, right) = problem(dice, count, count, 0.1);
        let all: Vec<usize> = (0..count).collect();
        let mut factor = Factor::default();
        for i in 0..count {
            put(&mut factor, i, &matrix, &all[..i], i);
        }
        assert!(factor.decompose(count), "{count}");
        let mut x = right.clone();
        factor.solve(&mut x);
        for i in 0..count {
            let sum: f64 = matrix[i].iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!(
                (sum - right[i]).abs() < 1e-9,
                "{count} {i}: {sum} {}",
                right[i]
            );
        }
        // The same row twice is found wherever it lies.
        if count > 1 {
            let (first, last) = (count / 3, count - 1);
            let twice = |i: usize| if i == last { first } else { i };
            for i in 0..count {
                let row = factor.row_mut(i);
                for j in 0..=i {
                    row[j] = matrix[twice(i)][twice(j)];
                }
            }
            assert!(!factor.decompose(count), "{count}");
        }
    }
}

#[test]
fn a_factor_kept_up_to_date_is_that_of_the_rows_that_stayed() {
    let dice = &mut Dice::new(8);
    let count = 70;
    let (matrix, right) = problem(dice, count, count, 0.1);
    let mut kept: Vec<usize> = (0..count).collect();
    let mut factor = Factor::default();
    for i in 0..count {
        put(&mut factor, i, &matrix, &kept[..i], i);
    }
    assert!(factor.decompose(count));
    for round in 0..200 {
        let away: Vec<usize> = (0..count).filter(|i| !kept.contains(i)).collect();
        if kept.len() == 1 || (!away.is_empty() && dice.within(0.0, 1.0) < 0.4) {
            let i = away[dice.within(0.0, away.len() as f64) as usize];
            put(&mut factor, kept.len(), &matrix, &kept, i);
            assert!(factor.append(), "{round}");
            kept.push(i);
        } else {
            let k = dice.within(0.0, kept.len() as f64) as usize;
            factor.remove(k);
            kept.remove(k);
        }
        let mut x: Vec<f64> = kept.iter().map(|&i| right[i]).collect();
        factor.solve(&mut x);
        for &i in &kept {
            let sum: f64 = kept.iter().zip(&x).map(|(&j, x)| matrix[i][j] * x).sum();
            assert!(
                (sum - right[i]).abs() < 1e-9,
                "{round} {i}: {sum} {}",
                right[i]
            );
        }
    }
    // The same row twice is not positive definite: it stays out, and all is as it was.
    let before = kept[0];
    put(&mut factor, kept.len(), &matrix, &kept, before);
    assert!(!factor.append());
    let mut x: Vec<f64> = kept.iter().map(|&i| right[i]).collect();
    factor.solve(&mut x);
    let sum: f64 = kept
        .iter()
        .zip(&x)
        .map(|(&j, x)| matrix[before][j] * x)
        .sum();
    assert!((sum - right[before]).abs() < 1e-9);
}
