//! Coulomb friction between tools and the contact points.
//!
//! Each point carries a force aside of at most the coefficient times its push. Where it is less, the
//! point sticks: it stays with its anchor, the place on the tool where it was; where it is that much
//! the point slips, and its anchor follows it. For given pushes the forces aside are those of least
//! energy within their discs (Tresca's problem, convex), found by projected Gauss-Seidel from the
//! forces before; pushes and forces aside take turns, once a linearisation (P. D. Panagiotopoulos,
//! 1975). What a tick leaves to be found the next ones find; the discs hold at any moment.

mod in_place;

use glam::{DVec2, DVec3};

use super::coefficients::{AllPosed, Posed};
use super::patch::Patch;
use crate::algebra::cholesky::dot_within;
use crate::algebra::wide::widely;
use crate::algebra::{MOST_POINTS, room};

/// Bounds on the sweeps in one linearisation; one there is always.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sweeping {
    pub sweeps: usize,
    /// Multiplications of these, about.
    pub work: usize,
}

impl Sweeping {
    /// From the tick before a few are enough.
    pub(crate) const IN_TICK: Self = Self {
        sweeps: 16,
        work: 80_000,
    };
    /// Without a clock.
    pub(crate) const UNHURRIED: Self = Self {
        sweeps: 320,
        work: 1_600_000,
    };
}

/// For fewer sweeps than these no matrix is set up.
const WORTH_A_MATRIX: usize = 2;
/// Forces that move their points by less than this share of the tool's reach have been found.
const CONVERGED: f64 = 1e-6;
/// A force aside within this share of its limit slips.
const SLIPPING: f64 = 1.0 - 1e-7;
/// Unknowns: two a point.
const MOST_UNKNOWNS: usize = 2 * MOST_POINTS;
/// From one row of the matrix to the next. Were that 320 numbers, a column would lie in an eighth of
/// the sets of a processor's first cache; as an odd number of its lines it lies in all.
const ROW: usize = MOST_UNKNOWNS + 8;

/// The forces aside of one linearisation and the memory to find them in.
#[derive(Debug, Clone)]
pub(crate) struct Rubbing {
    /// Slots that bear a force aside, two directions across the normal of each, the most it bears.
    rubbed: Vec<(usize, [DVec3; 2], f64)>,
    /// How far points move along these directions under a force along another, row by row.
    matrix: Vec<f64>,
    /// How far points are from their anchors under the forces to begin with.
    away: Vec<f64>,
    /// Forces along these directions, and how they differ from those to begin with.
    forces: Vec<f64>,
    changes: Vec<f64>,
    work: usize,
}

impl Rubbing {
    pub(crate) fn new() -> Self {
        Self {
            rubbed: Vec::with_capacity(MOST_POINTS),
            matrix: room(MOST_UNKNOWNS * ROW),
            away: vec![0.0; MOST_UNKNOWNS],
            forces: vec![0.0; MOST_UNKNOWNS],
            changes: vec![0.0; MOST_UNKNOWNS],
            work: 0,
        }
    }

    /// Multiplications that the last turn took, about.
    #[inline]
    pub(crate) fn work(&self) -> usize {
        self.work
    }

    /// Finds the forces aside for the pushes of all slots, and moves the slots; false where the bound
    /// on the sweeps ended it.
    pub(crate) fn rub(&mut self, patch: &mut Patch, tools: &AllPosed, most: Sweeping) -> bool {
        let near = patch.slots().len();
        self.rubbed.clear();
        let mut pressed = 0;
        for (number, slot) in patch.slots_mut().iter_mut().enumerate() {
            let tool = tools[usize::from(slot.tool)];
            let limit = tool.map_or(0.0, |tool| tool.friction.limit(slot));
            if limit > 0.0 {
                slot.aside = shortened(across(slot.aside, slot.normal), limit);
                let (first, second) = slot.normal.any_orthonormal_pair();
                self.rubbed.push((number, [first, second], limit));
            } else {
                slot.aside = DVec3::ZERO;
            }
            slot.force = slot.normal * slot.push + slot.aside;
            pressed += usize::from(slot.push > 0.0);
        }
        let rubbed = self.rubbed.len();
        self.work = 9 * pressed * near;
        if rubbed == 0 {
            patch.displace();
            return true;
        }
        let present = || tools.iter().flatten();
        let reach = present().fold(f64::INFINITY, |least, tool| least.min(tool.reach));
        let least = CONVERGED * reach;
        let sweep = 4 * rubbed * rubbed;
        let sweeps = (most.work / sweep).min(most.sweeps);
        if sweeps < WORTH_A_MATRIX {
            self.work += 9 * (rubbed + near) * near;
            return self.rub_in_place(patch, tools) <= least;
        }
        self.set_up(patch, tools);
        let rubbing = &mut *self;
        let (made, found) = sweep_through(rubbing, sweeps, least);
        for (&(number, [first, second], limit), force) in
            self.rubbed.iter().zip(self.forces.chunks_exact(2))
        {
            let slot = &mut patch.slots_mut()[number];
            slot.aside = shortened(first * force[0] + second * force[1], limit);
            slot.force = slot.normal * slot.push + slot.aside;
        }
        patch.displace();
        self.work += 9 * (rubbed + pressed) * near + 6 * rubbed * rubbed + made * sweep;
        found
    }

    /// Moves the slots as their forces ask for, and sets up Tresca's problem about these.
    fn set_up(&mut self, patch: &mut Patch, tools: &AllPosed) {
        patch.begin_sum(|slot| slot.force, |slot| slot.offset);
        let mut first = 0;
        for number in 0..patch.slots().len() {
            patch.add(number);
            if self.rubbed.get(first).is_some_and(|&(k, ..)| k == number) {
                self.set_rows(patch, first);
                first += 1;
            }
        }
        patch.end_displacing();
        for (k, &(number, directions, _)) in self.rubbed.iter().enumerate() {
            let slot = patch.slots()[number];
            let place = slot.at.position + slot.moved;
            let stuck = slot.anchor.zip(tools[usize::from(slot.tool)]);
            let anchor = stuck.map_or(place, |(anchor, tool)| tool.pose.to_body(anchor));
            for (a, direction) in directions.into_iter().enumerate() {
                self.away[2 * k + a] = direction.dot(place - anchor);
                self.forces[2 * k + a] = direction.dot(slot.aside);
                self.changes[2 * k + a] = 0.0;
            }
        }
    }

    /// The matrix between a point and those before it.
    fn set_rows(&mut self, patch: &mut Patch, k: usize) {
        let (number, directions, _) = self.rubbed[k];
        for (a, direction) in directions.into_iter().enumerate() {
            let [x, y, z] = patch.moved_by(number, direction);
            for (l, &(seen, across, _)) in self.rubbed[..=k].iter().enumerate() {
                let moved = DVec3::new(x[seen], y[seen], z[seen]);
                for (b, other) in across.into_iter().enumerate() {
                    let entry = other.dot(moved);
                    self.matrix[(2 * l + b) * ROW + 2 * k + a] = entry;
                    self.matrix[(2 * k + a) * ROW + 2 * l + b] = entry;
                }
            }
        }
    }
}

widely! {
    /// Sweeps until the forces stay, at most so many; how many, and whether they stayed. Each point
    /// in turn goes to its anchor, or as near as its limit lets it: the energy falls.
    fn sweep_through(rubbing: &mut Rubbing, most: usize, least: f64) -> (usize, bool) {
        let unknowns = 2 * rubbing.rubbed.len();
        for made in 1..=most {
            let mut largest = 0.0_f64;
            for (k, &(_, _, limit)) in rubbing.rubbed.iter().enumerate() {
                let rows = &rubbing.matrix[2 * k * ROW..][..2 * ROW];
                let (first, second) = rows.split_at(ROW);
                let changes = &rubbing.changes[..unknowns];
                let slip = DVec2::new(
                    rubbing.away[2 * k] + dot_within::<FUSED>(&first[..unknowns], changes),
                    rubbing.away[2 * k + 1] + dot_within::<FUSED>(&second[..unknowns], changes),
                );
                let (xx, xy, yy) = (first[2 * k], first[2 * k + 1], second[2 * k + 1]);
                let last = DVec2::new(rubbing.forces[2 * k], rubbing.forces[2 * k + 1]);
                let force = nearer(last, slip, [xx, xy, yy], limit);
                let change = force - last;
                for a in 0..2 {
                    rubbing.forces[2 * k + a] = force[a];
                    rubbing.changes[2 * k + a] += change[a];
                }
                largest = largest.max(change.abs().max_element() * (xx + yy));
            }
            if largest <= least {
                return (made, true);
            }
        }
        (most, false)
    }
}

/// The force within its limit that brings one point nearer to its anchor: all the way if it may.
#[inline(always)]
pub(crate) fn nearer(last: DVec2, slip: DVec2, own: [f64; 3], limit: f64) -> DVec2 {
    let [xx, xy, yy] = own;
    let determinant = xx * yy - xy * xy;
    if determinant > 0.0 {
        let there = DVec2::new(yy * slip.x - xy * slip.y, xx * slip.y - xy * slip.x);
        let sticking = last - there / determinant;
        if sticking.length_squared() <= limit * limit {
            return sticking;
        }
    }
    // The larger principal value: a step by its inverse lowers the energy.
    let half = 0.5 * (xx - yy);
    let largest = 0.5 * (xx + yy) + (half * half + xy * xy).sqrt();
    let tried = last - slip / largest;
    let length = tried.length();
    if length > limit {
        tried * (limit / length)
    } else {
        tried
    }
}

/// The part of a force across a normal.
#[inline]
pub(crate) fn across(force: DVec3, normal: DVec3) -> DVec3 {
    force - normal * normal.dot(force)
}

/// A force shortened to a limit.
#[inline]
fn shortened(force: DVec3, limit: f64) -> DVec3 {
    let length = force.length();
    if length > limit {
        force * (limit / length)
    } else {
        force
    }
}

/// After a tick: anchors of a tool's points on a body that stuck stay, others are where the points are. How much
/// of all pushes is on points that stick, 0 to 1.
pub(crate) fn take_anchors(patch: &mut Patch, pair: [u8; 2], tool: &Posed) -> f64 {
    let (mut stuck, mut all) = (0.0, 0.0);
    let Posed { pose, friction, .. } = tool;
    for slot in patch.slots_mut().iter_mut().filter(|slot| slot.is_of(pair)) {
        if slot.push <= 0.0 || friction.is_none() {
            (slot.aside, slot.anchor, slot.slips) = (DVec3::ZERO, None, false);
            continue;
        }
        all += slot.push;
        let is_held = slot.anchor.is_some();
        if is_held && slot.aside.length() < SLIPPING * friction.limit(slot) {
            slot.slips = false;
            stuck += slot.push;
        } else {
            slot.slips = is_held;
            slot.anchor = Some(pose.to_tool(slot.at.position + slot.moved));
        }
    }
    if all > 0.0 { stuck / all } else { 0.0 }
}
