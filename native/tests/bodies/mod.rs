//! Test bodies: a box cut into a grid, an icosphere, extruded voxels with concave edges.
#![allow(dead_code, unused_imports)] // Each test program takes what it needs.

mod compliant;
mod dice;
mod round;

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use palpate_servo::body::surface::Body;

pub use compliant::{
    compressed, compressed_parts, elastic, elastic_cube, giving_cube, giving_cube_in_parts,
};
pub use dice::Dice;
pub use round::{globe, lentil, sphere};

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
