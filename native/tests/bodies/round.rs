//! Round bodies.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;
use palpate_servo::body::surface::Body;

use super::soft;

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
