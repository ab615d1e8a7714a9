//! Balls around balls around the contact points: which of them are near a tool.

use glam::DVec3;

const LEAF_POINTS: usize = 8;
/// Halving splits keep the depth below 32 for any count that fits in `u32`.
const STACK: usize = 64;

#[derive(Debug, Clone, Copy)]
struct Ball {
    middle: DVec3,
    radius: f64,
    /// Leaf: first entry in `order`. Branch: the second child (the first one follows directly).
    index: u32,
    /// Points in a leaf, 0 for a branch.
    count: u32,
}

/// A binary tree over points that never move.
#[derive(Debug)]
pub(crate) struct PointTree {
    balls: Vec<Ball>,
    order: Vec<u32>,
}

impl PointTree {
    pub(crate) fn new(points: &[DVec3]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut balls = Vec::new();
        build(points, &mut order, 0, &mut balls);
        Self { balls, order }
    }

    /// Visits every point in a ball whose middle is at most its radius farther than wanted; `is_near`
    /// tells that of a middle and radius.
    #[inline]
    pub(crate) fn visit(&self, is_near: impl Fn(DVec3, f64) -> bool, mut each: impl FnMut(u32)) {
        let mut stack = [0_u32; STACK];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let number = stack[depth];
            let ball = &self.balls[number as usize];
            if !is_near(ball.middle, ball.radius) {
                continue;
            }
            if ball.count == 0 {
                stack[depth] = ball.index;
                stack[depth + 1] = number + 1;
                depth += 2;
            } else {
                for &point in &self.order[ball.index as usize..][..ball.count as usize] {
                    each(point);
                }
            }
        }
    }
}

fn build(points: &[DVec3], order: &mut [u32], first: u32, balls: &mut Vec<Ball>) {
    let at = |i: u32| points[i as usize];
    let low = (order.iter()).fold(DVec3::INFINITY, |low, &i| low.min(at(i)));
    let high = (order.iter()).fold(DVec3::NEG_INFINITY, |high, &i| high.max(at(i)));
    let middle = (low + high) * 0.5;
    let radius = (order.iter()).fold(0.0, |r: f64, &i| r.max(at(i).distance(middle)));
    let number = balls.len();
    balls.push(Ball {
        middle,
        radius,
        index: first,
        count: order.len() as u32,
    });
    if order.len() <= LEAF_POINTS {
        return;
    }
    let axis = (high - low).max_position();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&i, &j| at(i)[axis].total_cmp(&at(j)[axis]));
    balls[number].count = 0;
    let (left, right) = order.split_at_mut(half);
    build(points, left, first, balls);
    balls[number].index = balls.len() as u32;
    build(points, right, first + half as u32, balls);
}
