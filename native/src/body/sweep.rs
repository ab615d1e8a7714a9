//! First crossings of a segment with the surface; a query allocates nothing.
//!
//! Which triangles a segment crosses is decided by exact signs only, so a segment from outside to
//! inside always crosses at least one triangle inwards.

use glam::DVec3;

use crate::body::face::{Face, orientation};
use crate::body::surface::Body;
use crate::body::tree::{Node, STACK, Tree};

/// Crossing of a segment and a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Crossing {
    /// Part of the segment before the crossing, 0 to 1.
    pub fraction: f64,
    /// Triangle number.
    pub triangle: u32,
    /// Area coordinates; exact zeros when the segment meets an edge or node exactly.
    pub alpha: [f64; 3],
}

/// First crossings of a segment, inwards and outwards.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sweep {
    /// First crossing from the free side to the inside.
    pub entering: Option<Crossing>,
    /// First crossing from the inside to the free side.
    pub leaving: Option<Crossing>,
}

/// Triangles a sweep leaves out: those that contain all nodes of a feature it starts from.
#[derive(Debug, Clone, Copy)]
pub struct Feature {
    nodes: [u32; 3],
    count: usize,
}

impl Feature {
    /// No triangle is left out.
    pub const NONE: Self = Self {
        nodes: [0; 3],
        count: 0,
    };

    /// A node (all its triangles), an edge, or a triangle.
    pub fn new(nodes: &[u32]) -> Self {
        let mut feature = Self::NONE;
        feature.nodes[..nodes.len()].copy_from_slice(nodes);
        feature.count = nodes.len();
        feature
    }

    #[inline]
    fn is_in(&self, triangle: &[u32; 3]) -> bool {
        self.count > 0
            && self.nodes[..self.count]
                .iter()
                .all(|n| triangle.contains(n))
    }
}

impl Tree {
    /// First inward and outward crossing of the segment from `start` to `end`.
    pub fn sweep(&self, body: &Body, start: DVec3, end: DVec3, skip: &[Feature]) -> Sweep {
        self.sweep_faces((body.faces(), &body.triangles), start, end, skip)
    }

    /// The same of triangles that may have moved, with the nodes of each.
    pub(crate) fn sweep_faces(
        &self,
        (faces, triangles): (&[Face], &[[u32; 3]]),
        start: DVec3,
        end: DVec3,
        skip: &[Feature],
    ) -> Sweep {
        let mut found = Sweep::default();
        let low = start.min(end);
        let high = start.max(end);
        let half = (end - start) * 0.5;
        let middle = start + half;
        // Far above the rounding of the separating-axis test below; it only ever widens boxes.
        let reach = self.reach.max(low.abs().max(high.abs()).max_element());
        let margin = reach * half.abs().max_element() * 1e-12;
        let mut stack = [0_u32; STACK];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if node.low.cmpgt(high).any()
                || node.high.cmplt(low).any()
                || node.is_beside(middle, half, margin)
            {
                continue;
            }
            if node.count > 0 {
                let first = node.index as usize;
                for &t in &self.order[first..first + node.count as usize] {
                    if !skip.iter().any(|f| f.is_in(&triangles[t as usize])) {
                        found.add(&faces[t as usize], t, start, end);
                    }
                }
            } else {
                stack[depth] = node.index;
                stack[depth + 1] = index + 1;
                depth += 2;
            }
        }
        found
    }
}

impl Node {
    /// Whether the segment's line misses the box clearly, by the three cross-product axes.
    #[inline]
    fn is_beside(&self, middle: DVec3, half: DVec3, margin: f64) -> bool {
        let extent = (self.high - self.low) * 0.5;
        let offset = middle - (self.low + self.high) * 0.5;
        let along = half.abs();
        let cross = half.cross(offset).abs();
        let limit = DVec3::new(
            extent.y * along.z + extent.z * along.y,
            extent.x * along.z + extent.z * along.x,
            extent.x * along.y + extent.y * along.x,
        );
        cross.cmpgt(limit + margin).any()
    }
}

impl Sweep {
    #[inline]
    fn add(&mut self, face: &Face, triangle: u32, start: DVec3, end: DVec3) {
        if face.is_clearly_beside(start, end) {
            return;
        }
        let from = face.side(start);
        let to = face.side(end);
        let enters = from >= 0.0 && to < 0.0;
        let leaves = from < 0.0 && to > 0.0;
        if !enters && !leaves {
            return;
        }
        let slot = if enters {
            &mut self.entering
        } else {
            &mut self.leaving
        };
        let fraction = from / (from - to);
        if slot.is_some_and(|c| c.fraction <= fraction) {
            return;
        }
        let [a, b, c] = face.corners;
        let volumes = [
            orientation(start, end, b, c),
            orientation(start, end, c, a),
            orientation(start, end, a, b),
        ];
        let misses = volumes.iter().any(|&v| v < 0.0) && volumes.iter().any(|&v| v > 0.0);
        let sum: f64 = volumes.iter().sum();
        if !misses && sum != 0.0 {
            *slot = Some(Crossing {
                fraction,
                triangle,
                alpha: volumes.map(|v| v / sum),
            });
        }
    }
}
