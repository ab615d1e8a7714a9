//! The contact points near a tool, and how each gives way to a force on each other.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::blocks::Blocks;
use super::near_field::NearField;
use super::points::{Point, ToolSurface};
use crate::algebra::wide::widely;
use crate::algebra::{MOST_POINTS, room};
use crate::body::surface::Body;

/// Numbers of a column: how all slots give way to a force on one, an entry of the blocks after the
/// other, row by row, each for all slots.
const COLUMN: usize = 9 * MOST_POINTS;
/// The slot of a point that has none.
const NONE: u16 = u16::MAX;

/// A point near the tool.
#[derive(Debug, Clone, Copy, Default)]
pub struct Slot {
    /// Number of the contact point.
    pub point: u32,
    /// Force on the body, N at unit modulus.
    pub force: DVec3,
    /// The part of it along the normal, N at unit modulus.
    pub push: f64,
    /// The part of it across, by friction, N at unit modulus.
    pub aside: DVec3,
    /// Where on the tool the point stuck, in the tool's frame; nowhere before its second tick.
    pub anchor: Option<DVec3>,
    /// It slipped in the last tick.
    pub slips: bool,
    /// Displacement, m.
    pub moved: DVec3,
    /// The part of it that other fingers cause, m.
    pub offset: DVec3,
    /// Outward from the tool where the point has gone to.
    pub normal: DVec3,
    /// Signed distance from the tool there, m.
    pub distance: f64,
    /// Distance and normal where the point is now, of the tool as it is, in the tool's frame.
    pub(super) free: (f64, DVec3),
    /// The same as pushes are held, in the body's frame: what the next linearisation begins with.
    pub(super) seen: (f64, DVec3),
    /// Of the distances now and, where it was asked for, at rest the lesser, m.
    pub(super) nearest: f64,
    /// How far the point moves along an axis under a force along it, at most, m/N at unit modulus.
    pub(super) gives: f64,
}

/// Displacement of the point that enters per force on a node, and for which entry that was found:
/// contact points share nodes.
#[derive(Debug, Clone, Copy, Default)]
struct OfNode {
    resolved: (u64, DMat3),
    beyond: (u64, DMat3),
}

/// Slots in use and the compliance between them.
#[derive(Debug, Clone)]
pub struct Patch {
    slots: Vec<Slot>,
    slot_of: Vec<u16>,
    /// C_ij at unit modulus, a column for each loaded slot j.
    compliance: Vec<f64>,
    /// Displacements under all forces, an axis after the other, and under one.
    moved: [[f64; MOST_POINTS]; 3],
    by_one: [[f64; MOST_POINTS]; 3],
    blocks: Blocks,
    /// The same beyond a half-space.
    beyond: Blocks,
    of_nodes: Vec<OfNode>,
    /// Points that entered so far.
    entries: u64,
}

impl Patch {
    pub(super) fn new(points: usize, nodes: usize) -> Self {
        Self {
            slots: Vec::with_capacity(MOST_POINTS),
            slot_of: vec![NONE; points],
            compliance: room(COLUMN * MOST_POINTS),
            moved: [[0.0; MOST_POINTS]; 3],
            by_one: [[0.0; MOST_POINTS]; 3],
            blocks: Blocks::new(),
            beyond: Blocks::new(),
            of_nodes: vec![OfNode::default(); nodes],
            entries: 0,
        }
    }

    /// All slots in use.
    #[inline]
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    #[inline]
    pub(super) fn slots_mut(&mut self) -> &mut [Slot] {
        &mut self.slots
    }

    /// The slot of a point that has one.
    #[inline]
    pub(super) fn slot(&self, point: u32) -> Option<&Slot> {
        self.slots.get(usize::from(self.slot_of[point as usize]))
    }

    #[inline]
    pub(super) fn has(&self, point: u32) -> bool {
        self.slot_of[point as usize] != NONE
    }

    #[inline]
    pub(super) fn is_full(&self) -> bool {
        self.slots.len() == MOST_POINTS
    }

    /// How a slot gives way to a force on another, m/N at unit modulus.
    #[inline]
    fn compliance(&self, i: usize, j: usize) -> DMat3 {
        let entry =
            |r: usize, c: usize| self.compliance[j * COLUMN + (3 * r + c) * MOST_POINTS + i];
        DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| entry(r, c))))
    }

    /// How far slots move under a force on one of them, m at unit modulus, an axis after the other:
    /// that one and those behind it, by symmetry enough for a matrix.
    #[inline]
    pub(super) fn moved_by(&mut self, slot: usize, force: DVec3) -> &[[f64; MOST_POINTS]; 3] {
        let range = slot..self.slots.len();
        for axis in &mut self.by_one {
            axis[range.clone()].fill(0.0);
        }
        let column = &self.compliance[slot * COLUMN..][..COLUMN];
        let moved = &mut self.by_one;
        add_moved(column, force, moved, &range);
        &self.by_one
    }

    /// Begins to sum up how far all slots move, from zero.
    pub(super) fn begin_sum(&mut self) {
        for axis in &mut self.moved {
            axis[..self.slots.len()].fill(0.0);
        }
    }

    /// The same from what other fingers do.
    pub(super) fn begin_displacing(&mut self) {
        for (i, slot) in self.slots.iter().enumerate() {
            for (axis, offset) in self.moved.iter_mut().zip(slot.offset.to_array()) {
                axis[i] = offset;
            }
        }
    }

    /// Adds how far all slots move under a force on one of them. The columns of a full patch are more
    /// than a processor keeps at hand, so each is read once for all that it is needed for: this, and
    /// [`Self::moved_by`].
    #[inline]
    pub(super) fn add(&mut self, slot: usize, force: DVec3) {
        if force != DVec3::ZERO {
            let column = &self.compliance[slot * COLUMN..][..COLUMN];
            add_moved(column, force, &mut self.moved, &(0..self.slots.len()));
        }
    }

    /// The sum, m at unit modulus, an axis after the other.
    #[inline]
    pub(super) fn sum(&self) -> &[[f64; MOST_POINTS]; 3] {
        &self.moved
    }

    /// Displaces the slots by the sum.
    pub(super) fn end_displacing(&mut self) {
        for (i, slot) in self.slots.iter_mut().enumerate() {
            slot.moved = DVec3::from_array([0, 1, 2].map(|axis| self.moved[axis][i]));
        }
    }

    #[inline]
    pub(super) fn blocks_mut(&mut self) -> &mut Blocks {
        &mut self.blocks
    }

    /// How many blocks were not at hand so far.
    #[inline]
    pub(super) fn fetched(&self) -> usize {
        self.blocks.fetched() + self.beyond.fetched()
    }

    /// Takes a point in; there must be room.
    pub(super) fn enter(&mut self, surface: &ToolSurface, point: u32) {
        let new = self.slots.len();
        debug_assert!(new < MOST_POINTS && !self.has(point));
        self.slots.push(Slot {
            point,
            ..Slot::default()
        });
        self.slot_of[point as usize] = new as u16;
        self.entries += 1;
        for slot in 0..=new {
            let other = self.slots[slot].point;
            let block = self.response(surface, point, other);
            self.put(new, slot, block);
        }
        let own = self.compliance(new, new);
        let gives = [own.x_axis.x, own.y_axis.y, own.z_axis.z];
        self.slots[new].gives = gives.into_iter().fold(0.0, f64::max);
    }

    /// Displacement of the point that enters per force on another.
    fn response(&mut self, surface: &ToolSurface, point: u32, other: u32) -> DMat3 {
        let [p, q] = [point, other].map(|k| &surface.points()[k as usize]);
        let Some(near) = surface.near() else {
            return self.resolved(surface.body(), p, q);
        };
        if point == other {
            let whole = self.resolved(surface.body(), p, q) + near.points[point as usize].own;
            return (whole + whole.transpose()) * 0.5;
        }
        let normals = [p.normal, q.normal];
        let share = near.share(point, other, normals);
        let mut sum = DMat3::ZERO;
        if share < 1.0 {
            sum += self.resolved(surface.body(), p, q) * (1.0 - share);
        }
        if share > 0.0 {
            let offset = p.position - q.position;
            let half_space = near.between_points(point, other, offset, normals);
            sum += (self.beyond(surface.body(), near, p, q) + half_space) * share;
        }
        sum
    }

    /// What the finite elements have between the point that enters and another.
    fn resolved(&mut self, body: &Body, entered: &Point, other: &Point) -> DMat3 {
        let (blocks, kept, entry) = (&mut self.blocks, &mut self.of_nodes, self.entries);
        let mut found = |node: u32| {
            let kept = &mut kept[node as usize].resolved;
            if kept.0 != entry {
                *kept = (entry, over(entered, |a| blocks.get(body, a, node)));
            }
            kept.1
        };
        over(other, &mut found)
    }

    /// What the body does beyond a half-space between the point that enters and another.
    fn beyond(&mut self, body: &Body, near: &NearField, entered: &Point, other: &Point) -> DMat3 {
        let (blocks, kept, entry) = (&mut self.beyond, &mut self.of_nodes, self.entries);
        let resolved = |a: u32, b: u32| body.block(a, b).unwrap_or(DMat3::ZERO);
        let mut block = |a: u32, b: u32| {
            blocks.kept(a, b, |a, b| {
                let offset = body.nodes[a as usize] - body.nodes[b as usize];
                near.beyond(a, b, offset, resolved)
            })
        };
        let mut found = |node: u32| {
            let kept = &mut kept[node as usize].beyond;
            if kept.0 != entry {
                *kept = (entry, over(entered, |a| block(a, node)));
            }
            kept.1
        };
        over(other, &mut found)
    }

    /// Displaces one slot as the forces and its offset ask for.
    pub(super) fn displace_one(&mut self, slot: usize) {
        // By symmetry its own column tells how it moves under forces on the others.
        let column = &self.compliance[slot * COLUMN..][..COLUMN];
        let mut moved = self.slots[slot].offset;
        for (j, other) in self.slots.iter().enumerate() {
            if other.force != DVec3::ZERO {
                let entry = |r: usize, c: usize| column[(3 * r + c) * MOST_POINTS + j];
                let along = |c: usize| DVec3::new(entry(0, c), entry(1, c), entry(2, c));
                let along = [0, 1, 2].map(|c| along(c).dot(other.force));
                moved += DVec3::from_array(along);
            }
        }
        self.slots[slot].moved = moved;
    }

    #[inline]
    fn put(&mut self, i: usize, j: usize, block: DMat3) {
        for c in 0..3 {
            for r in 0..3 {
                let entry = block.col(c)[r];
                self.compliance[j * COLUMN + (3 * r + c) * MOST_POINTS + i] = entry;
                self.compliance[i * COLUMN + (3 * c + r) * MOST_POINTS + j] = entry;
            }
        }
    }

    /// Drops a slot; the last one takes its place.
    pub(super) fn leave(&mut self, slot: usize) {
        let last = self.slots.len() - 1;
        self.slot_of[self.slots[slot].point as usize] = NONE;
        if slot != last {
            let own = self.compliance(last, last);
            for other in 0..last {
                let block = self.compliance(last, other);
                self.put(slot, other, block);
            }
            self.put(slot, slot, own);
            self.slot_of[self.slots[last].point as usize] = slot as u16;
        }
        self.slots.swap_remove(slot);
    }

    /// Drops all.
    pub(super) fn clear(&mut self) {
        for slot in &self.slots {
            self.slot_of[slot.point as usize] = NONE;
        }
        self.slots.clear();
    }

    /// Moves every slot as its forces and the offset ask for.
    pub(super) fn displace(&mut self) {
        self.begin_displacing();
        for number in 0..self.slots.len() {
            self.add(number, self.slots[number].force);
        }
        self.end_displacing();
    }

    /// The contact point of a slot.
    #[inline]
    pub(super) fn point<'a>(&self, surface: &'a ToolSurface, slot: usize) -> &'a Point {
        &surface.points()[self.slots[slot].point as usize]
    }
}

/// The mean over the corners of a point's triangle, weighted with its area coordinates.
#[inline]
fn over(point: &Point, mut block: impl FnMut(u32) -> DMat3) -> DMat3 {
    let mut sum = DMat3::ZERO;
    for (&node, &weight) in point.nodes.iter().zip(&point.alpha) {
        if weight != 0.0 {
            sum += block(node) * weight;
        }
    }
    sum
}

widely! {
    /// Adds how far some slots move under a force on one of them.
    fn add_moved(
        column: &[f64],
        force: DVec3,
        moved: &mut [[f64; MOST_POINTS]; 3],
        range: &Range<usize>,
    ) {
        for (r, axis) in moved.iter_mut().enumerate() {
            let rows = &column[3 * r * MOST_POINTS..][..3 * MOST_POINTS];
            let x = &rows[range.start..range.end];
            let y = &rows[MOST_POINTS + range.start..MOST_POINTS + range.end];
            let z = &rows[2 * MOST_POINTS + range.start..2 * MOST_POINTS + range.end];
            let sums = &mut axis[range.start..range.end];
            for i in 0..sums.len() {
                sums[i] += x[i] * force.x + y[i] * force.y + z[i] * force.z;
            }
        }
    }
}
