//! Blocks of both forms against plain sums, what a body makes of them, and what is refused.

use std::sync::Arc;

use crate::bodies::Dice;
use glam::{DMat3, DVec3};
use palpate_servo::body::compliance::{Compliance, Compressed, CompressedParts, Dense, Either};
use palpate_servo::body::surface::Body;
use palpate_servo::contact::touch::{ContactMode, surface_displacement, touch};

const NODES: usize = 11;
const LEAF: usize = 4;
const TILES: usize = 2;

fn close(found: DMat3, expected: DMat3) -> bool {
    let size = expected
        .to_cols_array()
        .into_iter()
        .fold(0.0, |s: f64, x| s.max(x.abs()));
    (found - expected)
        .to_cols_array()
        .into_iter()
        .all(|x| x.abs() <= 1e-13 * size)
}

/// L_ij by the definition of the form, entry by entry.
fn by_definition(parts: &CompressedParts, i: usize, j: usize) -> DMat3 {
    let rows = 3 * LEAF;
    let (p, q) = (parts.places[i] as usize, parts.places[j] as usize);
    if p > q {
        return by_definition(parts, j, i).transpose();
    }
    let (r, c) = (p / LEAF, q / LEAF);
    let (a, b) = (3 * (p % LEAF), 3 * (q % LEAF));
    let all = parts.tile_counts.len() * TILES;
    let entry = |x: usize, y: usize| -> f64 {
        if i == j {
            return parts.own_blocks[9 * i + 3 * x + y];
        }
        if r == c {
            let Either::Short(near) = &parts.near else {
                unreachable!()
            };
            return f64::from(parts.near_steps[r])
                * f64::from(near[(r * rows + a + x) * rows + b + y])
                * f64::from(parts.near_scale[r * rows + a + x])
                * f64::from(parts.near_scale[c * rows + b + y]);
        }
        let basis = |cluster: usize, row: usize, pattern: usize| {
            f64::from(parts.basis[(cluster * rows + row) * 8 * TILES + pattern])
        };
        let mut sum = 0.0;
        for m in 0..8 * TILES {
            for k in 0..8 * TILES {
                let number = parts.tile_table[(r * TILES + m / 8) * all + c * TILES + k / 8];
                let place = |tile: usize| tile * 64 + (m % 8) * 8 + k % 8;
                let Either::Short(wide) = &parts.wide else {
                    unreachable!()
                };
                let coupled = match number {
                    0 => 0.0,
                    1.. => f64::from(parts.narrow[place(number as usize)]),
                    _ => f64::from(wide[place((-number - 1) as usize)]),
                };
                sum += basis(r, a + x, m) * coupled * basis(c, b + y, k);
            }
        }
        sum * f64::from(parts.steps[r].min(parts.steps[c]))
    };
    DMat3::from_cols_array_2d(&[0, 1, 2].map(|y| [0, 1, 2].map(|x| entry(x, y))))
}

#[test]
fn dense_blocks_lie_where_the_table_has_them() {
    let table: Vec<f32> = (0..9 * NODES * NODES).map(|k| k as f32).collect();
    let dense = Dense::new(NODES, Either::Short(table.into())).expect("n x 3 x 3n");
    let block = Compliance::Dense(dense).block(4, 7);
    for column in 0..3 {
        for row in 0..3 {
            let place = ((7 * 3 + column) * 3 * NODES + 3 * 4 + row) as f64;
            assert_eq!(block.col(column)[row], place);
        }
    }
}

#[test]
fn compressed_blocks_are_what_the_form_says() {
    let parts = crate::bodies::compressed_parts(&mut Dice::new(5), NODES, LEAF, TILES);
    let again = crate::bodies::compressed_parts(&mut Dice::new(5), NODES, LEAF, TILES);
    let compressed = Compressed::new(again).expect("sound parts");
    let compliance = Compliance::Compressed(Box::new(compressed));
    assert_eq!(
        (compliance.node_count(), compliance.form()),
        (NODES, "compressed")
    );
    for i in 0..NODES {
        for j in 0..NODES {
            let block = compliance.block(i, j);
            assert!(close(block, by_definition(&parts, i, j)), "{i} {j}");
            assert_eq!(block, compliance.block(j, i).transpose());
        }
    }
}

#[test]
fn displacements_are_sums_of_blocks_times_forces() {
    let mut dice = Dice::new(6);
    let table: Vec<f64> = (0..9 * NODES * NODES).map(|_| dice.unit()).collect();
    let dense = Dense::new(NODES, Either::Long(table.into())).expect("n x 3 x 3n");
    let both = [
        Compliance::Dense(dense),
        crate::bodies::compressed(&mut dice, NODES, LEAF, TILES),
    ];
    for compliance in both {
        let loads: Vec<(usize, DVec3)> = [3, 4, 9, 3].map(|j| (j, dice.direction())).to_vec();
        let moved = compliance.apply(&loads);
        assert_eq!(moved.len(), NODES);
        for (i, found) in moved.into_iter().enumerate() {
            let expected: DVec3 = loads.iter().map(|&(j, f)| compliance.block(i, j) * f).sum();
            assert!(
                (found - expected).length() <= 1e-5,
                "{i}: {found} {expected}"
            );
        }
    }
}

#[test]
fn the_touched_point_moves_by_the_blocks_of_its_triangle() {
    let (body, compliance, free) = crate::bodies::giving_cube_in_parts();
    let mut dice = Dice::new(3);
    let mut moves = 0;
    for triangle in 0..body.triangles.len() as u32 {
        let (a, b) = (dice.unit(), dice.unit());
        let alpha = [a.min(b), (a - b).abs(), 1.0 - a.max(b)];
        let forces = touch(
            &body,
            ContactMode::Paper,
            triangle,
            alpha,
            dice.direction() * 1e-3,
            1e4,
        )
        .nodal_forces;
        let mut expected = DVec3::ZERO;
        let corners = body.triangles[triangle as usize];
        for (a, (&i, weight)) in corners.iter().zip(alpha).enumerate() {
            for (b, (&j, force)) in corners.iter().zip(forces).enumerate() {
                let block = body.compliance_block(triangle, a, b).expect("it has one");
                let place = |node| free.iter().position(|&other| other == node);
                match (place(i), place(j)) {
                    (Some(i), Some(j)) => assert_eq!(block, compliance.block(i, j)),
                    _ => assert_eq!(block, DMat3::ZERO),
                }
                expected += block * force * weight / 1e4;
            }
        }
        let moved = surface_displacement(&body, triangle, alpha, &forces, 1e4).expect("so too");
        assert!((moved - expected).length() <= 1e-12 * expected.length());
        moves += u32::from(moved != DVec3::ZERO);
    }
    assert!(moves > 100);
    assert_eq!(
        surface_displacement(
            &crate::bodies::cube(),
            0,
            [1.0, 0.0, 0.0],
            &[DVec3::ONE; 3],
            1.0
        ),
        None
    );
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let refused = |change: fn(&mut CompressedParts), reason: &str| {
        let mut parts = crate::bodies::compressed_parts(&mut Dice::new(5), NODES, LEAF, TILES);
        change(&mut parts);
        let error = Compressed::new(parts).expect_err(reason);
        assert!(error.0.contains(reason), "{error}");
    };
    refused(|p| p.places[0] = 12, "places points beyond");
    refused(
        |p| p.places.truncate(10),
        "own_blocks has 99 numbers, not 90",
    );
    refused(|p| p.near_table[1] = 4, "near_table points beyond");
    refused(|p| p.near_table[0] = 0, "as its own neighbour");
    refused(|p| p.tile_table[2] = 1 << 20, "tile_table points beyond");
    refused(|p| p.tile_table[2] = i32::MIN, "tile_table points beyond");
    refused(|p| p.tile_counts[0] = 3, "basis has");
    refused(
        |p| {
            // Clusters without rows, and so many tiles that their table's size wraps around to 0.
            p.places.clear();
            p.own_blocks = Vec::new().into();
            p.near_scale = Vec::new().into();
            p.near = Either::Short(Vec::new().into());
            p.basis = Vec::new().into();
            p.tile_table.clear();
            p.tile_counts = vec![1 << 31, 1 << 30, 1 << 30];
        },
        "tile_counts",
    );
    refused(|p| p.steps = vec![1.0].into(), "steps has 1 numbers, not 3");
    refused(
        |p| p.narrow = Vec::new().into(),
        "narrow has 0 numbers, not 64",
    );
    refused(|p| p.near_scale = vec![1.0; 7].into(), "near_scale");
    let few = Dense::new(NODES, Either::Long(vec![0.0; 5].into())).expect_err("five numbers");
    assert!(few.0.contains("has 1089 numbers, not 5"), "{few}");
}

#[test]
fn a_compliance_of_other_nodes_is_refused() {
    let with = |free: &[u32]| {
        let compliance = crate::bodies::compressed(&mut Dice::new(1), 3, LEAF, TILES);
        let body: Body = Arc::into_inner(crate::bodies::cube()).expect("nobody else has it");
        body.with_compliance(&compliance, free)
            .map(|_| ())
            .map_err(|e| e.0)
    };
    assert_eq!(with(&[5, 0, 97]), Ok(()));
    assert!(with(&[5, 0]).unwrap_err().contains("2 free nodes"));
    assert!(
        with(&[5, 0, 98])
            .unwrap_err()
            .contains("beyond the 98 nodes")
    );
    assert!(with(&[5, 0, 5]).unwrap_err().contains("named free twice"));
}

#[test]
fn a_whole_body_has_a_block_for_any_two_nodes() {
    let compliance = Arc::new(crate::bodies::compressed(&mut Dice::new(1), 3, LEAF, TILES));
    let body = Arc::into_inner(crate::bodies::cube()).expect("nobody else has it");
    assert_eq!(body.block(5, 0), None);
    let body = (body.with_whole_compliance(compliance.clone(), &[5, 0, 97])).expect("it fits");
    assert_eq!(body.block(5, 97), Some(compliance.block(0, 2)));
    assert_eq!(body.block(0, 0), Some(compliance.block(1, 1)));
    // Pinned: as firm as its contact block, deaf to the others.
    let own = body.block(7, 7).expect("it is whole") * body.contact_blocks[7];
    assert!(close(own, DMat3::IDENTITY));
    assert_eq!(body.block(7, 5), Some(DMat3::ZERO));
}
