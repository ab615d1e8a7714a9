//! Test bodies: a box cut into a grid, an icosphere, extruded voxels with concave edges.
#![allow(dead_code)] // Each test file takes what it needs.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use palpate_servo::body::compliance::{Compliance, Compressed, CompressedParts, Dense, Either};
use palpate_servo::body::surface::Body;

pub fn soft(nodes: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Arc<Body> {
    let blocks = (0..nodes.len())
        .map(|i| {
            let s = 0.02 + 0.01 * ((i * 37 % 11) as f64 / 11.0);
            let c = 0.003 * ((i * 17 % 7) as f64 / 7.0);
            DMat3::from_cols_array(&[s, c, 0.0, c, s * 1.2, c, 0.0, c, s * 1.5])
        })
        .collect();
    Arc::new(Body::new(nodes, triangles, blocks).expect("a sound body"))
}

/// The outer surface of filled unit cells, scaled; each square cut along one diagonal or the other.
pub fn voxels(cells: &[[i32; 3]], edge: f64) -> Arc<Body> {
    let filled = |c: [i32; 3]| cells.contains(&c);
    let mut numbers: HashMap<[i32; 3], u32> = HashMap::new();
    let mut nodes = Vec::new();
    let mut triangles = Vec::new();
    for &cell in cells {
        for axis in 0..3 {
            for sign in [0, 1] {
                let mut beside = cell;
                beside[axis] += 2 * sign - 1;
                if filled(beside) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut square = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
                    let mut corner = cell;
                    corner[axis] += sign;
                    corner[u] += a;
                    corner[v] += b;
                    *numbers.entry(corner).or_insert_with(|| {
                        nodes.push(DVec3::from_array(corner.map(|k| f64::from(k) * edge)));
                        nodes.len() as u32 - 1
                    })
                });
                if sign == 0 {
                    square.reverse();
                }
                let [a, b, c, d] = square;
                if (cell[0] + cell[1] + cell[2]) % 2 == 0 {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
    }
    soft(nodes, triangles)
}

pub fn grid(x: i32, y: i32, z: i32) -> Vec<[i32; 3]> {
    (0..x)
        .flat_map(|i| (0..y).flat_map(move |j| (0..z).map(move |k| [i, j, k])))
        .collect()
}

/// The paper's cube: 50 mm, four cells an edge, 192 triangles.
pub fn cube() -> Arc<Body> {
    let body = voxels(&grid(4, 4, 4), 0.0125);
    assert_eq!((body.nodes.len(), body.triangles.len()), (98, 192));
    body
}

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

/// A bar with an inner corner along y.
pub fn angle_bar() -> Arc<Body> {
    let cells: Vec<_> = grid(4, 4, 4)
        .into_iter()
        .filter(|c| c[0] < 2 || c[2] < 2)
        .collect();
    voxels(&cells, 0.0125)
}

/// A room's corner: three planes meet inside.
pub fn inner_corner() -> Arc<Body> {
    let cells: Vec<_> = grid(4, 4, 4)
        .into_iter()
        .filter(|c| c[0] < 2 || c[1] < 2 || c[2] < 2)
        .collect();
    voxels(&cells, 0.0125)
}

/// Two blocks that share only an edge.
pub fn touching_blocks() -> Arc<Body> {
    voxels(&[[0, 0, 0], [1, 0, 1]], 0.0125)
}

/// Two blocks that share only a node.
pub fn touching_tips() -> Arc<Body> {
    voxels(&[[0, 0, 0], [1, 1, 1]], 0.0125)
}

/// Two blocks beside each other that share no node: their faces coincide at x = 12.5 mm.
pub fn parts_side_by_side() -> Arc<Body> {
    let block = voxels(&[[0, 0, 0]], 0.0125);
    let count = block.nodes.len() as u32;
    let aside = block.nodes.iter().map(|&p| p + DVec3::X * 0.0125);
    let nodes = block.nodes.iter().copied().chain(aside).collect();
    let other = block.triangles.iter().map(|t| t.map(|n| n + count));
    soft(
        nodes,
        block.triangles.iter().copied().chain(other).collect(),
    )
}

/// A wall of 50 x 50 mm, `thickness` thick.
pub fn wall(thickness: f64) -> Arc<Body> {
    let body = voxels(&grid(4, 4, 1), 1.0);
    let scale = DVec3::new(0.0125, 0.0125, thickness);
    let nodes = body.nodes.iter().map(|&p| p * scale).collect();
    soft(nodes, body.triangles.clone())
}

/// An icosphere around the origin.
pub fn sphere(radius: f64, halvings: u32) -> Arc<Body> {
    let g = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut nodes: Vec<DVec3> = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ]
    .map(|p| DVec3::from_array(p).normalize() * radius)
    .to_vec();
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..halvings {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    let middle = (nodes[p as usize] + nodes[q as usize]).normalize() * radius;
                    nodes.push(middle);
                    nodes.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    soft(nodes, triangles)
}

/// A ball with long thin triangles: an icosphere squeezed flat.
pub fn lentil() -> Arc<Body> {
    let ball = sphere(0.025, 3);
    let squeeze = DVec3::new(1.0, 0.02, 1.0);
    let nodes = ball.nodes.iter().map(|&p| p * squeeze).collect();
    soft(nodes, ball.triangles.clone())
}

/// A sphere of 51 meridians and 24 bands: 2,346 triangles, long and thin at the poles.
pub fn globe(radius: f64) -> Arc<Body> {
    let (meridians, bands) = (51_u32, 24_u32);
    let mut nodes = vec![DVec3::Z * radius];
    for band in 1..bands {
        let polar = std::f64::consts::PI * f64::from(band) / f64::from(bands);
        for meridian in 0..meridians {
            let azimuth = std::f64::consts::TAU * f64::from(meridian) / f64::from(meridians);
            let (s, c) = azimuth.sin_cos();
            nodes.push(DVec3::new(c * polar.sin(), s * polar.sin(), polar.cos()) * radius);
        }
    }
    nodes.push(-DVec3::Z * radius);
    let at = |band: u32, meridian: u32| 1 + (band - 1) * meridians + meridian % meridians;
    let south = nodes.len() as u32 - 1;
    let mut triangles = Vec::new();
    for m in 0..meridians {
        triangles.push([0, at(1, m), at(1, m + 1)]);
        for band in 1..bands - 1 {
            let (a, b) = (at(band, m), at(band + 1, m));
            let (c, d) = (at(band + 1, m + 1), at(band, m + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([south, at(bands - 1, m + 1), at(bands - 1, m)]);
    }
    assert_eq!(triangles.len(), 2346);
    soft(nodes, triangles)
}

/// A block cut into 200 slices: triangles 200 times longer than wide.
pub fn needles() -> Arc<Body> {
    sliced(200)
}

/// A block of 50 mm cut into slices along z.
pub fn sliced(slices: i32) -> Arc<Body> {
    let body = voxels(&grid(1, 1, slices), 1.0);
    let scale = DVec3::new(0.05, 0.05, 0.05 / f64::from(slices));
    let nodes = body.nodes.iter().map(|&p| p * scale).collect();
    soft(nodes, body.triangles.clone())
}

/// The cube, every triangle split at a point `gap` beside its first edge: caps with an angle of
/// nearly 180 degrees.
pub fn caps(gap: f64) -> Arc<Body> {
    let cube = cube();
    let mut nodes = cube.nodes.clone();
    let mut triangles = Vec::new();
    for (t, &[a, b, c]) in cube.triangles.iter().enumerate() {
        let face = cube.face(t as u32);
        let middle = (face.corners[0] * 0.4 + face.corners[1] * 0.6) + face.inward[0] * gap;
        let d = nodes.len() as u32;
        nodes.push(middle);
        triangles.extend([[a, b, d], [b, c, d], [c, a, d]]);
    }
    soft(nodes, triangles)
}

/// The cube with a triangle of `edge` in each of its triangles, `height` above them.
pub fn speckled(edge: f64, height: f64) -> Arc<Body> {
    let cube = cube();
    let mut nodes = cube.nodes.clone();
    let mut triangles = Vec::new();
    for (t, &corners) in cube.triangles.iter().enumerate() {
        let face = cube.face(t as u32);
        let middle = face.at([1.0 / 3.0; 3]) + face.normal * height;
        let first = nodes.len() as u32;
        nodes.extend(
            face.corners
                .map(|p| middle + (p - middle).normalize() * edge),
        );
        let inner = [first, first + 1, first + 2];
        triangles.push(inner);
        for k in 0..3 {
            let l = (k + 1) % 3;
            triangles.extend([
                [corners[k], corners[l], inner[k]],
                [corners[l], inner[l], inner[k]],
            ]);
        }
    }
    soft(nodes, triangles)
}

/// Turned by odd angles.
pub fn turned_by(v: DVec3) -> DVec3 {
    let turn = DMat3::from_rotation_x(0.7123) * DMat3::from_rotation_y(-1.1931);
    turn * DMat3::from_rotation_z(2.4173) * v
}

/// Turned by odd angles and scaled: nothing lies along an axis any more.
pub fn turned(body: &Body, scale: f64) -> Arc<Body> {
    let nodes = body.nodes.iter().map(|&p| turned_by(p) * scale).collect();
    soft(nodes, body.triangles.clone())
}

/// Every kind of body that a push may meet, under its name.
pub fn pushed_bodies() -> Vec<(&'static str, Arc<Body>)> {
    vec![
        ("cube", cube()),
        ("sphere", sphere(0.025, 3)),
        ("globe", globe(0.025)),
        ("angle bar", angle_bar()),
        ("inner corner", inner_corner()),
        ("lentil", lentil()),
        ("wall 0.5 mm", wall(5e-4)),
        ("wall 10 um", wall(1e-5)),
        ("touching blocks", touching_blocks()),
        ("touching tips", touching_tips()),
        ("needles", needles()),
        ("caps", caps(1e-7)),
        ("caps 1 nm", caps(1e-9)),
        ("specks 0.3 um", speckled(3e-7, 1e-7)),
        ("dents 0.3 um", speckled(3e-7, -1e-7)),
        ("turned cube", turned(&cube(), 1.0)),
        ("turned needles", turned(&needles(), 1.0)),
        ("turned caps", turned(&caps(1e-7), 1.0)),
        ("turned specks", turned(&speckled(3e-7, 1e-7), 1.0)),
        ("turned lentil", turned(&lentil(), 1.0)),
        ("1 mm", turned(&angle_bar(), 0.02)),
        ("10 m", turned(&angle_bar(), 200.0)),
    ]
}

/// The same numbers on every machine.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn bits(&mut self) -> u64 {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(
                self.within(-1.0, 1.0),
                self.within(-1.0, 1.0),
                self.within(-1.0, 1.0),
            );
            if (0.01..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }
}
