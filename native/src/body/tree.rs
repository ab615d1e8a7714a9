//! Bounding boxes over the triangles, and the closest point; queries allocate nothing.

use glam::DVec3;

use crate::body::face::{Face, closest_on_face};

const LEAF_TRIANGLES: usize = 4;
/// Halving splits keep the depth below 32 for any count that fits in `u32`.
pub(super) const STACK: usize = 64;

#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    /// Leaf: first entry in `order`. Branch: the second child (the first one follows directly).
    pub(super) index: u32,
    /// Triangles in a leaf, 0 for a branch.
    pub(super) count: u32,
}

/// A binary tree of axis-aligned boxes.
#[derive(Debug, Clone)]
pub struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) order: Vec<u32>,
    /// Largest coordinate in absolute value, for the rounding margin of box tests.
    pub(super) reach: f64,
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

    /// Has the boxes fit around triangles that have moved.
    pub(crate) fn refit(&mut self, faces: &[Face]) {
        // Children stand behind their parents.
        for index in (0..self.nodes.len()).rev() {
            let node = self.nodes[index];
            let [low, high] = if node.count > 0 {
                let first = node.index as usize;
                let own = &self.order[first..first + node.count as usize];
                let corners = own.iter().flat_map(|&t| faces[t as usize].corners);
                corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], at| {
                    [low.min(at), high.max(at)]
                })
            } else {
                let [a, b] = [index + 1, node.index as usize].map(|child| self.nodes[child]);
                [a.low.min(b.low), a.high.max(b.high)]
            };
            (self.nodes[index].low, self.nodes[index].high) = (low, high);
        }
        self.reach = (self.nodes[0].low.abs())
            .max(self.nodes[0].high.abs())
            .max_element();
    }

    /// What each box has of its triangles, by what one of these has and how that of two is joined.
    pub(crate) fn gather<T: Copy>(
        &self,
        gathered: &mut Vec<T>,
        empty: T,
        of: impl Fn(u32) -> T,
        join: impl Fn(T, T) -> T,
    ) {
        gathered.clear();
        gathered.resize(self.nodes.len(), empty);
        // Children stand behind their parents.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let first = node.index as usize;
            gathered[index] = if node.count > 0 {
                let own = &self.order[first..first + node.count as usize];
                own.iter().map(|&t| of(t)).fold(empty, &join)
            } else {
                join(gathered[index + 1], gathered[first])
            };
        }
    }

    /// Visits triangles in boxes that are wanted, by number, and within a reach of `p`, which each
    /// visit may lessen.
    pub(crate) fn visit_within(
        &self,
        p: DVec3,
        reach: f64,
        is_wanted: impl Fn(usize) -> bool,
        mut visit: impl FnMut(u32) -> f64,
    ) {
        let (mut reach, mut stack, mut depth) = (reach, [0_u32; STACK], 1);
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !is_wanted(index as usize) || node.distance_squared(p) > reach * reach {
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
                reach = visit(triangle);
            }
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
}

impl Node {
    #[inline]
    fn distance_squared(&self, p: DVec3) -> f64 {
        p.clamp(self.low, self.high).distance_squared(p)
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
