//! The contact points near all tools, and how each gives way to a force on each other.

mod memory;
mod products;
mod response;
mod slot_numbers;

use std::ops::Range;

use glam::{DMat3, DVec3};

use products::{Vectors, add_along, add_both, add_moved};
use products::{at, fill_up, gather, gather_and_add, set};
use slot_numbers::SlotNumbers;

use super::blocks::{Blocks, Recent};
use super::points::ToolSurface;
use super::slot::Slot;
use crate::algebra::MOST_POINTS;
use crate::contact::ground::{Ground, MOST_TOOLS};

/// Numbers of a slot: how those up to it give way to a force on it, an entry of the blocks after the
/// other, row by row, each for all of them and without room for more: what is read in one go comes
/// twice as soon. How others do follows by symmetry: a processor can keep half of a full patch at
/// hand, but not all of it.
fn blocks_at(slot: usize) -> Range<usize> {
    let (whole, rest) = (slot / WIDE, slot % WIDE);
    let before = WIDE * whole * (whole + 1) / 2 + rest * (whole + 1);
    9 * WIDE * before..9 * WIDE * (before + whole + 1)
}

/// Each entry begins at a multiple of so many numbers.
const WIDE: usize = 8;

/// Slots in use and the compliance between them.
#[derive(Debug, Clone)]
pub struct Patch {
    slots: Vec<Slot>,
    numbers: SlotNumbers,
    /// C_ij at unit modulus, [`blocks_at`] each loaded slot j; zero where nothing is kept.
    compliance: Vec<f64>,
    /// Forces whose displacements are summed up, and these.
    forces: Vectors,
    moved: Vectors,
    /// Displacements under one force.
    by_one: Vectors,
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
            compliance: vec![0.0; blocks_at(MOST_POINTS).start],
            forces: [[0.0; MOST_POINTS]; 3],
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

    /// How slots up to one give way to a force on it.
    #[inline]
    fn blocks_of(&self, slot: usize) -> &[f64] {
        &self.compliance[blocks_at(slot)]
    }

    /// How a slot gives way to a force on another, m/N at unit modulus.
    #[inline]
    pub(crate) fn compliance(&self, i: usize, j: usize) -> DMat3 {
        let (low, high) = (i.min(j), i.max(j));
        let blocks = self.blocks_of(high);
        let count = blocks.len() / 9;
        let entry = |r: usize, c: usize| blocks[(3 * r + c) * count + low];
        let block = DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| entry(r, c))));
        if i <= j { block } else { block.transpose() }
    }

    /// How far slots move under a force on one of them, m at unit modulus: that one and those before
    /// it, by symmetry enough for a matrix.
    #[inline]
    pub(crate) fn moved_by(&mut self, slot: usize, force: DVec3) -> &Vectors {
        for axis in &mut self.by_one {
            axis[..=slot].fill(0.0);
        }
        let blocks = &self.compliance[blocks_at(slot)];
        add_moved(blocks, force, &mut self.by_one, slot + 1);
        &self.by_one
    }

    /// How far they move along a way of each.
    #[inline]
    pub(crate) fn moved_along(&self, slot: usize, force: DVec3, ways: &Vectors, along: &mut [f64]) {
        add_along(self.blocks_of(slot), force, ways, &mut along[..=slot]);
    }

    /// The same of a push and a force aside on it, the second added to what is there; how far that
    /// slot moves along its push by the forces aside on those before it, a unit push given.
    #[inline]
    pub(crate) fn moved_by_both(
        &self,
        slot: usize,
        forces: [DVec3; 2],
        ways_and_asides: [&Vectors; 2],
        moved: [&mut [f64; MOST_POINTS]; 2],
    ) -> f64 {
        add_both(self.blocks_of(slot), forces, ways_and_asides, moved)
    }

    /// Begins to sum up how far forces move all slots, from a displacement of each.
    pub(crate) fn begin_sum(
        &mut self,
        force: impl Fn(&Slot) -> DVec3,
        from: impl Fn(&Slot) -> DVec3,
    ) {
        for (i, slot) in self.slots.iter().enumerate() {
            set(&mut self.forces, i, force(slot));
            set(&mut self.moved, i, from(slot));
        }
        fill_up(&mut self.forces, self.slots.len());
    }

    /// Adds what a slot and those before it do to each other. Once for each slot that is loaded or
    /// asked about, in their order, this makes the sum: what is kept of a slot is read once for all
    /// that it is needed for.
    #[inline]
    pub(crate) fn add(&mut self, slot: usize) {
        if at(&self.forces, slot) == DVec3::ZERO {
            self.see(slot);
            return;
        }
        let blocks = &self.compliance[blocks_at(slot)];
        let by_others = gather_and_add(blocks, &mut self.forces, slot, &mut self.moved);
        let moved = self.summed(slot) + DVec3::from_array(by_others);
        set(&mut self.moved, slot, moved);
    }

    /// Adds how far the forces on the slots before one move it; how far it moves so far.
    #[inline]
    pub(crate) fn see(&mut self, slot: usize) -> DVec3 {
        let blocks = &self.compliance[blocks_at(slot)];
        let by_others = DVec3::from_array(gather(blocks, &mut self.forces, slot));
        let moved = self.summed(slot) + by_others;
        set(&mut self.moved, slot, moved);
        moved
    }

    /// Adds how far a slot and those before it move under a force on it, which those behind have yet
    /// to [`Self::see`].
    #[inline]
    pub(crate) fn load(&mut self, slot: usize, force: DVec3) {
        set(&mut self.forces, slot, force);
        if force != DVec3::ZERO {
            let blocks = &self.compliance[blocks_at(slot)];
            add_moved(blocks, force, &mut self.moved, slot + 1);
        }
    }

    /// Goes on with the sum from other forces than those that it has: none so far.
    pub(crate) fn begin_changes(&mut self) {
        for axis in &mut self.forces {
            axis[..self.slots.len()].fill(0.0);
        }
    }

    /// How far a slot moves by the sum, m at unit modulus.
    #[inline]
    pub(crate) fn summed(&self, slot: usize) -> DVec3 {
        at(&self.moved, slot)
    }

    /// Displaces the slots by the sum.
    pub(crate) fn end_displacing(&mut self) {
        for (i, slot) in self.slots.iter_mut().enumerate() {
            slot.moved = at(&self.moved, i);
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
        kin: &[bool; MOST_TOOLS],
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
            let carried = ground.carried(at.position, other.arm);
            let block = self.response(ground, near, points);
            self.put(new, slot, block + carried);
        }
        let own = self.compliance(new, new);
        let gives = [own.x_axis.x, own.y_axis.y, own.z_axis.z];
        self.slots[new].gives = gives.into_iter().fold(0.0, f64::max);
    }

    /// How far the forces on some slots move one, m.
    pub(crate) fn moved_of(&self, slot: usize, counts: impl Fn(&Slot) -> bool) -> DVec3 {
        let mut moved = DVec3::ZERO;
        for (j, other) in self.slots.iter().enumerate() {
            if other.force != DVec3::ZERO && counts(other) {
                moved += self.compliance(slot, j) * other.force;
            }
        }
        moved
    }

    #[inline]
    fn put(&mut self, i: usize, j: usize, block: DMat3) {
        let (low, high) = (i.min(j), i.max(j));
        let block = if i <= j { block } else { block.transpose() };
        let blocks = &mut self.compliance[blocks_at(high)];
        let count = blocks.len() / 9;
        for c in 0..3 {
            for r in 0..3 {
                blocks[(3 * r + c) * count + low] = block.col(c)[r];
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

    /// Moves every slot as its forces and the offset ask for.
    pub(crate) fn displace(&mut self) {
        self.begin_sum(|slot| slot.force, |slot| slot.offset);
        for number in 0..self.slots.len() {
            self.add(number);
        }
        self.end_displacing();
    }
}
