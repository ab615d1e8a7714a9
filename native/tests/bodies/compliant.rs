//! The cube with made-up compliances.

use std::sync::Arc;

use glam::DMat3;
use palpate_servo::body::compliance::{Compliance, Compressed, CompressedParts, Dense, Either};
use palpate_servo::body::surface::Body;

use super::{Dice, cube};

/// The cube with a compressed compliance made of far blocks alone wherever that can be: the form
/// that costs a tick the most. The lowest nodes are pinned.
pub fn giving_cube() -> Arc<Body> {
    Arc::new(giving_cube_in_parts().0)
}

/// The same, its compliance, and the nodes that this counts.
pub fn giving_cube_in_parts() -> (Body, Compliance, Vec<u32>) {
    let body = Arc::into_inner(cube()).expect("nobody else has it");
    let free: Vec<u32> = (0..body.nodes.len() as u32)
        .filter(|&node| body.nodes[node as usize].z > 0.0)
        .collect();
    let compliance = compressed(&mut Dice::new(8), free.len(), 4, 2);
    let body = body.with_compliance(&compliance, &free).expect("it fits");
    (body, compliance, free)
}

/// The cube with a made-up compliance that a real body could have: symmetric, positive definite,
/// falling off with distance, contact blocks that belong to it. The lowest nodes are pinned.
pub fn elastic_cube() -> Arc<Body> {
    elastic(&cube())
}

/// The body's surface with such a compliance, pinned where it is lowest.
pub fn elastic(body: &Body) -> Arc<Body> {
    let lowest = body.nodes.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let free: Vec<u32> = (0..body.nodes.len() as u32)
        .filter(|&node| body.nodes[node as usize].z > lowest + 1e-9)
        .collect();
    let shape = DMat3::from_cols_array(&[9.0, 1.0, 0.5, 1.0, 7.0, -0.8, 0.5, -0.8, 11.0]);
    // Stiffer one way than another, and not alike near and far.
    let near = DMat3::from_cols_array(&[4.0, -1.5, 1.0, -1.5, 2.0, 0.3, 1.0, 0.3, 1.5]);
    let block = |a: u32, b: u32| {
        let gap = body.nodes[a as usize].distance(body.nodes[b as usize]);
        shape * (-gap / 0.02).exp() + near * (-gap / 0.008).exp()
    };
    let mut table = Vec::new();
    for &loaded in &free {
        for axis in 0..3 {
            let column = |&moved: &u32| block(moved, loaded).col(axis).to_array();
            table.extend(free.iter().flat_map(column));
        }
    }
    let dense = Dense::new(free.len(), Either::Long(table.into())).expect("n x 3 x 3n");
    let blocks = vec![(shape + near).inverse(); body.nodes.len()];
    let body = Body::new(body.nodes.clone(), body.triangles.clone(), blocks).expect("sound");
    let whole = body.with_whole_compliance(Arc::new(Compliance::Dense(dense)), &free);
    Arc::new(whole.expect("it fits"))
}

/// Made-up parts of a compressed compliance: clusters that are near to themselves alone, with as
/// many tiles each as told, every third tile missing and every fifth wide.
pub fn compressed_parts(
    dice: &mut Dice,
    nodes: usize,
    leaf: usize,
    tiles: usize,
) -> CompressedParts {
    let clusters = nodes.div_ceil(leaf);
    let (rows, all) = (3 * leaf, clusters * tiles);
    let mut own_blocks = Vec::new();
    for _ in 0..nodes {
        let [a, b, c] = [0, 1, 2].map(|_| dice.within(-0.1, 0.1));
        own_blocks.extend([1.0, a, b, a, 1.2, c, b, c, 0.8]);
    }
    let mut near: Vec<i16> = vec![0; clusters * rows * rows];
    for block in near.chunks_mut(rows * rows) {
        for r in 0..rows {
            for c in 0..=r {
                // The blocks L_ii are kept apart.
                let number = if r / 3 == c / 3 {
                    0
                } else {
                    dice.below(200) as i16 - 100
                };
                (block[r * rows + c], block[c * rows + r]) = (number, number);
            }
        }
    }
    let mut tile_table = vec![0; all * all];
    let (mut narrow, mut wide) = (vec![0_i8; 64], Vec::new());
    for row in 0..all {
        for column in (row / tiles + 1) * tiles..all {
            let number = match (row + column) % 15 {
                0 | 3 | 6 | 9 | 12 => 0,
                5 | 10 => {
                    wide.extend((0..64).map(|_| dice.below(2000) as i16 - 1000));
                    -(wide.len() as i32 / 64)
                }
                _ => {
                    narrow.extend((0..64).map(|_| dice.below(200) as i8));
                    narrow.len() as i32 / 64 - 1
                }
            };
            (
                tile_table[row * all + column],
                tile_table[column * all + row],
            ) = (number, number);
        }
    }
    let mut floats = |count: usize, low: f64, high: f64| -> Vec<f32> {
        (0..count).map(|_| dice.within(low, high) as f32).collect()
    };
    CompressedParts {
        places: (0..nodes as u32).rev().collect(),
        own_blocks: own_blocks.into(),
        near_scale: floats(clusters * rows, 0.5, 2.0).into(),
        near_table: (0..clusters * clusters)
            .map(|k| if k / clusters == k % clusters { k / clusters + 1 } else { 0 } as u32)
            .collect(),
        near_steps: floats(clusters, 1e-3, 2e-3).into(),
        near: Either::Short(near.into()),
        tile_counts: vec![tiles as u32; clusters],
        basis: floats(rows * 8 * all, -0.3, 0.3).into(),
        steps: floats(clusters, 1e-3, 2e-3).into(),
        tile_table,
        narrow: narrow.into(),
        wide: Either::Short(wide.into()),
    }
}

/// A compliance of these parts.
pub fn compressed(dice: &mut Dice, nodes: usize, leaf: usize, tiles: usize) -> Compliance {
    let parts = compressed_parts(dice, nodes, leaf, tiles);
    Compliance::Compressed(Box::new(Compressed::new(parts).expect("sound parts")))
}
