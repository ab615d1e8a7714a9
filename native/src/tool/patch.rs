//! The contact points near a tool, and how each gives way to a force on each other.

use glam::{DMat3, DVec3};

use super::blocks::Blocks;
use super::points::{Point, ToolSurface};
use super::wide::widely;
use super::{MOST_POINTS, room};

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
    /// Signed distance of the place at rest, m.
    pub at_rest: f64,
}

/// Slots in use and the compliance between them.
#[derive(Debug)]
pub struct Patch {
    slots: Vec<Slot>,
    slot_of: Vec<u16>,
    /// C_ij at unit modulus, a column for each loaded slot j.
    compliance: Vec<f64>,
    /// Displacements, an axis after the other.
    moved: [[f64; MOST_POINTS]; 3],
    blocks: Blocks,
    /// The same beyond a half-space.
    beyond: Blocks,
}

impl Patch {
    pub(super) fn new(points: usize) -> Self {
        Self {
            slots: Vec::with_capacity(MOST_POINTS),
            slot_of: vec![NONE; points],
            compliance: room(COLUMN * MOST_POINTS),
            moved: [[0.0; MOST_POINTS]; 3],
            blocks: Blocks::new(),
            beyond: Blocks::new(),
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

    /// How far all slots move under a force on one of them, m at unit modulus, an axis after the
    /// other.
    #[inline]
    pub(super) fn moved_by(&mut self, slot: usize, force: DVec3) -> &[[f64; MOST_POINTS]; 3] {
        let count = self.slots.len();
        for axis in &mut self.moved {
            axis[..count].fill(0.0);
        }
        let column = &self.compliance[slot * COLUMN..][..COLUMN];
        let moved = &mut self.moved;
        widely!(add_moved(column, force, moved, count));
        &self.moved
    }

    /// How far all slots move under their forces aside, m at unit modulus, an axis after the other.
    pub(super) fn moved_aside(&mut self) -> &[[f64; MOST_POINTS]; 3] {
        let count = self.slots.len();
        for axis in &mut self.moved {
            axis[..count].fill(0.0);
        }
        for (slot, column) in self.slots.iter().zip(self.compliance.chunks_exact(COLUMN)) {
            if slot.aside != DVec3::ZERO {
                let (force, moved) = (slot.aside, &mut self.moved);
                widely!(add_moved(column, force, moved, count));
            }
        }
        &self.moved
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
        for slot in 0..=new {
            let other = self.slots[slot].point;
            let block = self.response(surface, point, other);
            self.put(new, slot, block);
        }
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

    /// Displacement of a point per force on another.
    fn response(&mut self, surface: &ToolSurface, point: u32, other: u32) -> DMat3 {
        let [p, q] = [point, other].map(|k| &surface.points()[k as usize]);
        let body = surface.body();
        let Some(near) = surface.near() else {
            return between(p, q, |a, b| self.blocks.get(body, a, b));
        };
        if point == other {
            let sum = between(p, q, |a, b| self.blocks.get(body, a, b));
            let whole = sum + near.points[point as usize].own;
            return (whole + whole.transpose()) * 0.5;
        }
        let normals = [p.normal, q.normal];
        let share = near.share(point, other, normals);
        let mut sum = DMat3::ZERO;
        if share < 1.0 {
            sum += between(p, q, |a, b| self.blocks.get(body, a, b)) * (1.0 - share);
        }
        if share > 0.0 {
            let beyond = &mut self.beyond;
            sum += share
                * between(p, q, |a, b| {
                    beyond.kept(a, b, |a, b| {
                        let offset = body.nodes[a as usize] - body.nodes[b as usize];
                        let resolved = body.block(a, b).unwrap_or(DMat3::ZERO);
                        near.beyond(a, b, offset, resolved)
                    })
                });
            let offset = p.position - q.position;
            sum += near.between_points(point, other, offset, normals) * share;
        }
        sum
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

    /// Moves every slot as its forces and the offset ask for; the largest change, m.
    pub(super) fn displace(&mut self) -> f64 {
        let count = self.slots.len();
        for (i, slot) in self.slots.iter().enumerate() {
            for (axis, offset) in self.moved.iter_mut().zip(slot.offset.to_array()) {
                axis[i] = offset;
            }
        }
        for (slot, column) in self.slots.iter().zip(self.compliance.chunks_exact(COLUMN)) {
            if slot.force != DVec3::ZERO {
                let (force, moved) = (slot.force, &mut self.moved);
                widely!(add_moved(column, force, moved, count));
            }
        }
        let mut change = 0.0_f64;
        for (i, slot) in self.slots.iter_mut().enumerate() {
            let moved = DVec3::from_array([0, 1, 2].map(|axis| self.moved[axis][i]));
            let step = (moved - slot.moved).abs().max_element();
            // What is no number stays one.
            change = if change.is_nan() {
                change
            } else {
                change.max(step)
            };
            slot.moved = moved;
        }
        change
    }

    /// The contact point of a slot.
    #[inline]
    pub(super) fn point<'a>(&self, surface: &'a ToolSurface, slot: usize) -> &'a Point {
        &surface.points()[self.slots[slot].point as usize]
    }
}

/// Blocks between the corners of two points' triangles, weighted with their area coordinates.
#[inline]
fn between(p: &Point, q: &Point, mut block: impl FnMut(u32, u32) -> DMat3) -> DMat3 {
    let mut sum = DMat3::ZERO;
    for (&a, &weight) in p.nodes.iter().zip(&p.alpha) {
        for (&b, &load) in q.nodes.iter().zip(&q.alpha) {
            if weight != 0.0 && load != 0.0 {
                sum += block(a, b) * (weight * load);
            }
        }
    }
    sum
}

/// Adds how far slots move under a force on one of them.
#[inline(always)]
fn add_moved(column: &[f64], force: DVec3, moved: &mut [[f64; MOST_POINTS]; 3], count: usize) {
    for (axis, rows) in moved.iter_mut().zip(column.chunks_exact(3 * MOST_POINTS)) {
        let (x, rest) = rows.split_at(MOST_POINTS);
        let (y, z) = rest.split_at(MOST_POINTS);
        let entries = x.iter().zip(y).zip(z);
        for (sum, ((x, y), z)) in axis[..count].iter_mut().zip(entries) {
            *sum += x * force.x + y * force.y + z * force.z;
        }
    }
}
