//! The inverse Hessian of limited-memory BFGS (J. Nocedal, S. J. Wright: Numerical Optimization, 2nd
//! edition, 2006, section 7.2), with Powell's damping (section 18.3) and K^-1 to begin with.

use std::collections::VecDeque;

use super::domains::Nodal;
use crate::algebra::wide::widely;

/// Changes that are kept.
const KEPT: usize = 24;
/// A pair of changes keeps at least this share of the curvature that was expected.
const LEAST_CURVATURE: f64 = 0.2;

/// A vector of each node.
pub type Field = Vec<[f64; 3]>;

/// Change of place and gradient by a step, and the work of the two.
#[derive(Debug, Clone)]
struct Change {
    place: Field,
    gradient: Field,
    work: f64,
    /// Its share in the direction that is made.
    share: f64,
}

/// The last changes.
#[derive(Debug, Clone)]
pub struct History {
    changes: VecDeque<Change>,
    spare: Vec<Change>,
}

impl History {
    /// Room for the changes of so many nodes.
    pub fn new(nodes: usize) -> Self {
        let change = Change {
            place: vec![[0.0; 3]; nodes],
            gradient: vec![[0.0; 3]; nodes],
            work: 0.0,
            share: 0.0,
        };
        Self {
            changes: VecDeque::with_capacity(KEPT),
            spare: vec![change; KEPT],
        }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.spare.extend(self.changes.drain(..));
    }

    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.changes.is_empty()
    }

    /// Takes a step of `share` of a direction, minus H times the gradient `before`.
    pub fn take(&mut self, share: f64, direction: &Nodal, before: &Nodal, after: &Nodal) {
        let oldest = || self.changes.pop_front();
        let Some(mut change) = self.spare.pop().or_else(oldest) else {
            return;
        };
        for (node, place) in change.place.iter_mut().enumerate() {
            for axis in 0..3 {
                place[axis] = share * direction[node][axis];
                change.gradient[node][axis] = after[node][axis] - before[node][axis];
            }
        }
        // H^-1 times the step is known without H: it is -share times the gradient.
        let expected = -share * dot(before, &change.place);
        change.work = dot(&change.place, &change.gradient);
        if change.work < LEAST_CURVATURE * expected {
            let kept = (1.0 - LEAST_CURVATURE) * expected / (expected - change.work);
            for (gradient, before) in change.gradient.iter_mut().zip(before) {
                for axis in 0..3 {
                    gradient[axis] = kept * gradient[axis] - (1.0 - kept) * share * before[axis];
                }
            }
            change.work = LEAST_CURVATURE * expected;
        }
        self.changes.push_back(change);
    }

    /// `direction` becomes minus the inverse Hessian times the gradient `slope`; `left` is room, and `solve`
    /// takes it to K^-1 of it.
    pub fn direct(
        &mut self,
        slope: &Nodal,
        left: &mut Nodal,
        direction: &mut Nodal,
        solve: impl FnOnce(&Nodal, &mut Nodal),
    ) {
        left.copy_from_slice(slope);
        for change in self.changes.iter_mut().rev() {
            change.share = ratio(dot(&change.place, left), change.work);
            add(left, -change.share, &change.gradient);
        }
        solve(left, direction);
        for change in &self.changes {
            let more = change.share - ratio(dot(&change.gradient, direction), change.work);
            add(direction, more, &change.place);
        }
        scale(direction, -1.0);
    }
}

/// Zero where the change is: it has arrived.
fn ratio(work: f64, curvature: f64) -> f64 {
    if curvature > 0.0 {
        work / curvature
    } else {
        0.0
    }
}

widely! {
    /// The work of nodal forces on displacements.
    pub fn dot(a: &Nodal, b: &Nodal) -> f64 {
        let (a, b) = (a.as_flattened(), b.as_flattened());
        let mut sums = [0.0; 8];
        let whole = a.len() / 8 * 8;
        for (a, b) in a[..whole].chunks_exact(8).zip(b[..whole].chunks_exact(8)) {
            for lane in 0..8 {
                sums[lane] += a[lane] * b[lane];
            }
        }
        let mut sum = 0.0;
        for part in sums {
            sum += part;
        }
        for (a, b) in a[whole..].iter().zip(&b[whole..]) {
            sum += a * b;
        }
        sum
    }
}

widely! {
    /// Adds so much of another.
    pub fn add(to: &mut Nodal, times: f64, other: &Nodal) {
        for (to, other) in to.as_flattened_mut().iter_mut().zip(other.as_flattened()) {
            *to += times * other;
        }
    }
}

/// Becomes so much of itself.
pub fn scale(field: &mut Nodal, by: f64) {
    for vector in field {
        *vector = vector.map(|x| by * x);
    }
}
