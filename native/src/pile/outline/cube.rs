//! A cube that tests look at.

use std::collections::HashMap;

use glam::{DMat3, DVec3};

use crate::body::surface::Body;

const CELLS: i32 = 6;

/// A cube of one metre about the origin, of many triangles a side.
pub(super) fn cube() -> Body {
    let (mut numbers, mut nodes, mut triangles) = (HashMap::new(), Vec::new(), Vec::new());
    let mut number = |at: [i32; 3]| {
        *numbers.entry(at).or_insert_with(|| {
            nodes.push(DVec3::from_array(at.map(f64::from)) / f64::from(CELLS) - 0.5);
            nodes.len() as u32 - 1
        })
    };
    for cell in 0..6 * CELLS * CELLS {
        let (i, j, face) = (cell % CELLS, cell / CELLS % CELLS, cell / CELLS / CELLS);
        let (axis, side) = ((face / 2) as usize, face % 2);
        let [a, mut b, c, mut d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| {
            let mut at = [side * CELLS; 3];
            (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (i + x, j + y);
            number(at)
        });
        if side == 0 {
            (b, d) = (d, b);
        }
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    let blocks = vec![DMat3::IDENTITY; nodes.len()];
    Body::new(nodes, triangles, blocks).expect("sound")
}
