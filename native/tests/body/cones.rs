//! Forces that only push, by the conditions of the least energy, for random compliances.

use glam::{DMat3, DVec3};
use palpate_servo::contact::cones::{Blocks, Cone, MAX_FINGERS, Members, Vectors, solve_distinct};

use crate::bodies::Dice;

const BODIES: usize = 300;
/// Ticks in which the rounds come to their end.
const TICKS: usize = 40;
const SMALL: f64 = 1e-9;

/// Symmetric, positive definite, firmer one way than another; fingers hold each other strongly.
fn random_compliance(dice: &mut Dice, fingers: usize) -> Blocks {
    let rows = 3 * fingers;
    let factor: Vec<Vec<f64>> = (0..rows)
        .map(|_| (0..rows).map(|_| dice.within(-1.0, 1.0)).collect())
        .collect();
    let entry = |i: usize, j: usize| {
        let sum: f64 = factor[i].iter().zip(&factor[j]).map(|(a, b)| a * b).sum();
        sum + if i == j { 0.1 } else { 0.0 }
    };
    let mut blocks = [[DMat3::ZERO; MAX_FINGERS]; MAX_FINGERS];
    for (p, row) in blocks.iter_mut().enumerate().take(fingers) {
        for (q, block) in row.iter_mut().enumerate().take(fingers) {
            let column = |j: usize| DVec3::from([0, 1, 2].map(|i| entry(3 * p + i, 3 * q + j)));
            *block = DMat3::from_cols(column(0), column(1), column(2));
        }
    }
    blocks
}

/// Axis and tangent of the half angle: twice as wide as the force of a finger alone needs.
fn cone(own: &DMat3, push: DVec3) -> (DVec3, f64) {
    let axis = push.normalize();
    let alone = own.inverse() * axis;
    let along = alone.dot(axis);
    (
        axis,
        (2.0 * (alone - axis * along).length() / along).max(1.0),
    )
}

fn is_in_cone(force: DVec3, (axis, width): (DVec3, f64), small: f64) -> bool {
    let along = force.dot(axis);
    (force - axis * along).length() <= width * along + small
}

#[test]
fn forces_in_cones_are_those_of_least_energy_for_random_compliances() {
    let mut dice = Dice::new(300);
    let mut kinds = [0; 3];
    for body in 0..BODIES {
        let fingers = 2 + body % (MAX_FINGERS - 1);
        let compliance = random_compliance(&mut dice, fingers);
        let mut there = [None; MAX_FINGERS];
        there[..fingers].fill(Some(()));
        let members = Members::of(&there);
        let (mut asked, mut pushes) = (Vectors::default(), Vectors::default());
        let mut cones = [Cone::default(); MAX_FINGERS];
        for p in 0..fingers {
            asked[p] = dice.direction() * dice.within(0.1, 1.0);
            pushes[p] = asked[p] + dice.direction() * 0.3;
            cones[p] = Cone::about(pushes[p], &compliance[p][p]).unwrap();
        }
        let mut forces = Vectors::default();
        for _ in 0..TICKS {
            forces = solve_distinct(&compliance, &asked, &cones, &members, &forces).unwrap();
        }
        let largest = forces.iter().map(|f| f.length()).fold(0.0, f64::max);
        for p in 0..fingers {
            let moved: DVec3 = (0..fingers).map(|q| compliance[p][q] * forces[q]).sum();
            let left = moved - asked[p];
            let (axis, width) = cone(&compliance[p][p], pushes[p]);
            let name = format!("body {body}, finger {p}");
            assert!(
                is_in_cone(forces[p], (axis, width), SMALL * largest),
                "{name}"
            );
            // The surface has gone on in the dual cone, across the force.
            assert!(
                is_in_cone(left, (axis, 1.0 / width), SMALL),
                "{name}: {left}"
            );
            assert!(
                forces[p].dot(left).abs() <= SMALL * largest.max(1.0),
                "{name}"
            );
            let is_held = left.length() <= SMALL;
            kinds[if is_held {
                0
            } else {
                1 + usize::from(forces[p] == DVec3::ZERO)
            }] += 1;
        }
    }
    // Held, sliding on the rim of the cone, let go.
    assert!(kinds.iter().all(|&count| count > BODIES / 20), "{kinds:?}");
}
