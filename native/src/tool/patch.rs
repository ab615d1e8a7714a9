//! The contact points near all tools, and how each gives way to a force on each other.

mod response;
mod slot_numbers;

use std::ops::Range;

use glam::{DMat3, DVec3};

use slot_numbers::SlotNumbers;

use super::blocks::{Blocks, Recent};
use super::points::ToolSurface;
use super::slot::Slot;
use crate::algebra::wide::widely;
use crate::algebra::{MOST_POINTS, room};
use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::Ground;

/// Numbers of a column: how all slots give way to a force on one, an entry of the blocks after the
/// other, row by row, each for all slots.
const COLUMN: usize = 9 * MOST_POINTS;

/// Slots in use and the compliance between them.
#[derive(Debug, Clone)]
pub struct Patch {
    slots: Vec<Slot>,
    numbers: SlotNumbers,
    /// C_ij at unit modulus, a column for each loaded slot j.
    compliance: Vec<f64>,
    /// Displacements under all forces, an axis after the other, and under one.
    moved: [[f64; MOST_POINTS]; 3],
    by_one: [[f64; MOST_POINTS]; 3],
    blocks: Blocks,
    /// The same beyond a half-space.
    beyond: Blocks,
    /// Displacement of the point that enters per force on a node, by either.
    of_nodes: [Recent; 2],
}

impl Patch {
    pub(crate) fn new() -> Self {
        Self {
            slots: Vec::with_capacity(MOST_POINTS),
            numbers: SlotNumbers::new(),
            compliance: room(COLUMN * MOST_POINTS),
            moved: [[0.0; MOST_POINTS]; 3],
            by_one: [[0.0; MOST_POINTS]; 3],
            blocks: Blocks::new(),
            beyond: Blocks::new(),
            of_nodes: [Recent::new(), Recent::new()],
        }
    }

    /// All slots in use.
    #[inline]
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    #[inline]
    pub(crate) fn slots_mut(&mut self) -> &mut [Slot] {
        &mut self.slots
    }

    /// The slot of a tool's point on a body that has one.
    #[inline]
    pub(crate) fn slot(&self, pair: [u8; 2], point: u32) -> Option<&Slot> {
        self.numbers
            .of(pair, point)
            .map(|number| &self.slots[number])
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
    pub(crate) fn moved_by(&mut self, slot: usize, force: DVec3) -> &[[f64; MOST_POINTS]; 3] {
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
    pub(crate) fn begin_sum(&mut self) {
        for axis in &mut self.moved {
            axis[..self.slots.len()].fill(0.0);
        }
    }

    /// The same from what points do.
    pub(crate) fn begin_displacing(&mut self) {
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
    pub(crate) fn add(&mut self, slot: usize, force: DVec3) {
        if force != DVec3::ZERO {
            let column = &self.compliance[slot * COLUMN..][..COLUMN];
            add_moved(column, force, &mut self.moved, &(0..self.slots.len()));
        }
    }

    /// The sum, m at unit modulus, an axis after the other.
    #[inline]
    pub(crate) fn sum(&self) -> &[[f64; MOST_POINTS]; 3] {
        &self.moved
    }

    /// Displaces the slots by the sum.
    pub(crate) fn end_displacing(&mut self) {
        for (i, slot) in self.slots.iter_mut().enumerate() {
            slot.moved = DVec3::from_array([0, 1, 2].map(|axis| self.moved[axis][i]));
        }
    }

    #[inline]
    pub(crate) fn blocks_mut(&mut self) -> &mut Blocks {
        &mut self.blocks
    }

    /// How many blocks were not at hand so far.
    #[inline]
    pub(crate) fn fetched(&self) -> usize {
        self.blocks.fetched() + self.beyond.fetched()
    }

    /// Takes a tool's point on a body in; there must be room. `kin` tells of tools which have the same
    /// points there.
    pub(crate) fn enter(
        &mut self,
        ground: &Ground<'_>,
        surface: &ToolSurface,
        pair: [u8; 2],
        point: u32,
        kin: &[bool; MAX_FINGERS],
    ) {
        let new = self.slots.len();
        debug_assert!(new < MOST_POINTS && self.slot(pair, point).is_none());
        let at = &surface.points()[point as usize];
        self.slots.push(Slot::new(pair, point, at));
        self.numbers.set(pair, point, new);
        self.of_nodes.iter_mut().for_each(Recent::begin);
        for slot in 0..=new {
            let other = &self.slots[slot];
            if other.body != pair[1] {
                self.put(new, slot, DMat3::ZERO);
                continue;
            }
            let near = surface.near().filter(|_| kin[usize::from(other.tool)]);
            let points = [(point, at), (other.point, &{ other.at })];
            let block = self.response(ground, near, points);
            self.put(new, slot, block);
        }
        let own = self.compliance(new, new);
        let gives = [own.x_axis.x, own.y_axis.y, own.z_axis.z];
        self.slots[new].gives = gives.into_iter().fold(0.0, f64::max);
    }

    /// How far the forces on some slots move one, m.
    pub(crate) fn moved_of(&self, slot: usize, counts: impl Fn(&Slot) -> bool) -> DVec3 {
        // By symmetry its own column tells how it moves under forces on the others.
        let column = &self.compliance[slot * COLUMN..][..COLUMN];
        let mut moved = DVec3::ZERO;
        for (j, other) in self.slots.iter().enumerate() {
            if other.force != DVec3::ZERO && counts(other) {
                let entry = |r: usize, c: usize| column[(3 * r + c) * MOST_POINTS + j];
                let along = |c: usize| DVec3::new(entry(0, c), entry(1, c), entry(2, c));
                let along = [0, 1, 2].map(|c| along(c).dot(other.force));
                moved += DVec3::from_array(along);
            }
        }
        moved
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
    pub(crate) fn leave(&mut self, slot: usize) {
        let last = self.slots.len() - 1;
        let gone = self.slots[slot];
        self.numbers.remove([gone.tool, gone.body], gone.point);
        if slot != last {
            let own = self.compliance(last, last);
            for other in 0..last {
                let block = self.compliance(last, other);
                self.put(slot, other, block);
            }
            self.put(slot, slot, own);
            let moved = self.slots[last];
            self.numbers
                .set([moved.tool, moved.body], moved.point, slot);
        }
        self.slots.swap_remove(slot);
    }

    /// Drops some.
    pub(crate) fn let_go(&mut self, goes: impl Fn(&Slot) -> bool) {
        for slot in (0..self.slots.len()).rev() {
            if goes(&self.slots[slot]) {
                self.leave(slot);
            }
        }
    }

    /// Moves every slot as its forces and the offset ask for.
    pub(crate) fn displace(&mut self) {
        self.begin_displacing();
        for number in 0..self.slots.len() {
            self.add(number, self.slots[number].force);
        }
        self.end_displacing();
    }
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
