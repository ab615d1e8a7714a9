//! Bounding boxes over the triangles: closest point, and first crossing of a segment.
//!
//! Queries allocate nothing. Which triangles a segment crosses is decided by exact signs only, so
//! a segment from outside to inside always crosses at least one triangle inwards.

use glam::DVec3;

use crate::body::face::{Face, orientation};
use crate::body::surface::Body;

const LEAF_TRIANGLES: usize = 4;
/// Halving splits keep the depth below 32 for any count that fits in `u32`.
const STACK: usize = 64;

#[derive(Debug, Clone, Copy)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// Leaf: first entry in `order`. Branch: the second child (the first one follows directly).
    index: u32,
    /// Triangles in a leaf, 0 for a branch.
    count: u32,
}

/// A binary tree of axis-aligned boxes.
#[derive(Debug)]
pub struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    /// Largest coordinate in absolute value, for the rounding margin of box tests.
    reach: f64,
}

/// Nearest point of the surface.
#[derive(Debug, Clone, Copy)]
pub struct Closest {
    /// Triangle number.
    pub triangle: u32,
    /// Area coordinates; exact zeros on edges and nodes.
    pub alpha: [f64; 3],
    /// The point, m.
    pub point: DVec3,
    /// Unsigned distance, m.
    pub distance: f64,
}

/// Where a segment crosses a triangle.
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
    pub(crate) fn new(faces: &[Face]) -> Self {
        let mut order: Vec<u32> = (0..faces.len() as u32).collect();
        let mut nodes = Vec::with_capacity(faces.len());
        build(faces, &mut order, 0, &mut nodes);
        let reach = nodes[0].low.abs().max(nodes[0].high.abs()).max_element();
        Self {
            nodes,
            order,
            reach,
        }
    }

    pub(crate) fn diagonal(&self) -> f64 {
        self.nodes[0].low.distance(self.nodes[0].high)
    }

    /// Nearest surface point to `p`; `hint` is a triangle that is likely near.
    pub fn closest(&self, faces: &[Face], p: DVec3, hint: u32) -> Closest {
        let (alpha, point) = closest_on_face(&faces[hint as usize], p);
        let mut best = (point.distance_squared(p), hint, alpha, point);
        let mut stack = [(0_u32, 0.0_f64); STACK];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (index, bound) = stack[depth];
            if bound >= best.0 {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let first = node.index as usize;
                for &t in &self.order[first..first + node.count as usize] {
                    let (alpha, point) = closest_on_face(&faces[t as usize], p);
                    let squared = point.distance_squared(p);
                    if squared < best.0 {
                        best = (squared, t, alpha, point);
                    }
                }
                continue;
            }
            let (a, b) = (index + 1, node.index);
            let da = self.nodes[a as usize].distance_squared(p);
            let db = self.nodes[b as usize].distance_squared(p);
            let (near, far) = if da <= db {
                ((a, da), (b, db))
            } else {
                ((b, db), (a, da))
            };
            stack[depth] = far;
            stack[depth + 1] = near;
            depth += 2;
        }
        Closest {
            triangle: best.1,
            alpha: best.2,
            point: best.3,
            distance: best.0.sqrt(),
        }
    }

    /// A point of a triangle no farther from `p` than `reach`, on a triangle that `is_wanted`.
    pub fn find_within(
        &self,
        faces: &[Face],
        p: DVec3,
        reach: f64,
        is_wanted: impl Fn(&Face, f64) -> bool,
    ) -> Option<Closest> {
        let mut stack = [0_u32; STACK];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if node.distance_squared(p) > reach * reach {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.index;
                stack[depth + 1] = index + 1;
                depth += 2;
                continue;
            }
            let first = node.index as usize;
            for &triangle in &self.order[first..first + node.count as usize] {
                let face = &faces[triangle as usize];
                let (alpha, point) = closest_on_face(face, p);
                let distance = point.distance(p);
                if distance <= reach && is_wanted(face, distance) {
                    return Some(Closest {
                        triangle,
                        alpha,
                        point,
                        distance,
                    });
                }
            }
        }
        None
    }

    /// First inward and outward crossing of the segment from `start` to `end`.
    pub fn sweep(&self, body: &Body, start: DVec3, end: DVec3, skip: &[Feature]) -> Sweep {
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
                    if !skip.iter().any(|f| f.is_in(&body.triangles[t as usize])) {
                        found.add(body.face(t), t, start, end);
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
    #[inline]
    fn distance_squared(&self, p: DVec3) -> f64 {
        p.clamp(self.low, self.high).distance_squared(p)
    }

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

fn build(faces: &[Face], order: &mut [u32], offset: usize, nodes: &mut Vec<Node>) {
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    let mut middle_low = DVec3::INFINITY;
    let mut middle_high = DVec3::NEG_INFINITY;
    for &t in order.iter() {
        let corners = &faces[t as usize].corners;
        for &p in corners {
            low = low.min(p);
            high = high.max(p);
        }
        let middle = centroid(corners);
        middle_low = middle_low.min(middle);
        middle_high = middle_high.max(middle);
    }
    let here = nodes.len();
    let leaf = order.len() <= LEAF_TRIANGLES;
    nodes.push(Node {
        low,
        high,
        index: offset as u32,
        count: if leaf { order.len() as u32 } else { 0 },
    });
    if leaf {
        return;
    }
    let axis = (middle_high - middle_low).max_position();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&s, &t| {
        let key = |t: u32| centroid(&faces[t as usize].corners)[axis];
        key(s).total_cmp(&key(t))
    });
    let (first, second) = order.split_at_mut(half);
    build(faces, first, offset, nodes);
    nodes[here].index = nodes.len() as u32;
    build(faces, second, offset + half, nodes);
}

fn centroid(corners: &[DVec3; 3]) -> DVec3 {
    (corners[0] + corners[1] + corners[2]) / 3.0
}

/// Nearest point of a triangle by Voronoi regions (Ericson 2005, section 5.1.5).
pub(crate) fn closest_on_face(face: &Face, p: DVec3) -> ([f64; 3], DVec3) {
    let [a, b, c] = face.corners;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([1.0, 0.0, 0.0], a);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return ([0.0, 1.0, 0.0], b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let s = d1 / (d1 - d3);
        return ([1.0 - s, s, 0.0], a + ab * s);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return ([0.0, 0.0, 1.0], c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let s = d2 / (d2 - d6);
        return ([1.0 - s, 0.0, s], a + ac * s);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && (d4 - d3) >= 0.0 && (d5 - d6) >= 0.0 {
        let s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([0.0, 1.0 - s, s], b + (c - b) * s);
    }
    // Inside by the tests above; rounding may still say a hair less than zero.
    let alpha = face.area_coordinates(p).map(|a| a.max(0.0));
    (alpha, face.at(alpha))
}
