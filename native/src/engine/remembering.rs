//! What bodies remember of past forces, in a tick.

use glam::DVec3;

use super::joint::{AllLed, Joint};
use crate::contact::ground::{Ground, Memories};
use crate::creep::memory::Memory;
use crate::creep::step::Trace;
use crate::fingers::press::{Answers, Presses, numbered};

/// Loads the bodies with what presses them at the end of a tick, and ends it.
pub(super) fn end(
    memories: &mut Memories,
    grounds: &[Ground<'_>],
    presses: &Presses,
    answers: Option<&Answers>,
    led: &AllLed<'_>,
) {
    for (number, (memory, ground)) in memories.iter_mut().zip(grounds).enumerate() {
        if memory.step().is_none() {
            continue;
        }
        for (p, press) in numbered(presses) {
            let acts = press.touches && usize::from(press.body) == number;
            if let Some(answers) = answers.filter(|_| acts) {
                let nodes = ground.body.triangles[press.hold.triangle as usize];
                for (node, share) in nodes.into_iter().zip(press.hold.alpha) {
                    memory.load(node, answers[p].force * share);
                }
            }
        }
        for tool in led.iter().flatten() {
            for &(node, force) in tool.collider.nodal_forces(number) {
                memory.load(node, force);
            }
        }
        memory.end(&ground.body.nodes);
    }
}

impl Joint {
    /// The same presses, which know how far past forces move their places.
    pub(super) fn recalled(
        &mut self,
        grounds: &[Ground<'_>],
        presses: &Presses,
        memories: &Memories,
    ) -> Presses {
        if memories.iter().all(Memory::is_empty) {
            return *presses;
        }
        presses.map(|press| {
            let mut press = press?;
            let body = usize::from(press.body);
            if let Some(ground) = grounds.get(body) {
                let nodes = ground.body.triangles[press.hold.triangle as usize];
                let alpha = press.hold.alpha;
                let [before, now] = self.moved_by_memory((body, ground), memories, nodes, alpha);
                (press.remembered, press.carried) = (now, now - before);
            }
            Some(press)
        })
    }

    /// How far past forces move a place in a triangle, in the last tick and in this one, m.
    pub(super) fn moved_by_memory(
        &mut self,
        (body, ground): (usize, &Ground<'_>),
        memories: &Memories,
        nodes: [u32; 3],
        alpha: [f64; 3],
    ) -> [DVec3; 2] {
        let place = [0, 1, 2].map(|k| (nodes[k], alpha[k]));
        let blocks = self.patch.blocks_mut();
        memories[body].moved(&place, |a, b| blocks.get(ground, a, b))
    }

    /// Tells each slot how far what it remembers moves it.
    pub(super) fn remember(&mut self, memories: &Memories) {
        for slot in self.patch.slots_mut() {
            let step = memories[usize::from(slot.body)].step();
            if step.is_none() {
                slot.trace = Trace::default();
            }
            let now = slot.trace.ahead(step);
            slot.carried = now - slot.remembered;
            slot.remembered = now;
        }
    }

    /// The same for a slot that has just come in: it remembers what the surface does.
    pub(super) fn recall(&mut self, place: usize, grounds: &[Ground<'_>], memories: &Memories) {
        let slot = &self.patch.slots()[place];
        let (at, body) = (slot.at, usize::from(slot.body));
        let Some((memory, ground)) = (grounds.get(body))
            .map(|ground| (&memories[body], ground))
            .filter(|(memory, _)| !memory.is_empty())
        else {
            return;
        };
        let nodes = [0, 1, 2].map(|k| (at.nodes[k], at.alpha[k]));
        let blocks = self.patch.blocks_mut();
        let trace = memory.trace(&nodes, |a, b| blocks.get(ground, a, b));
        let slot = &mut self.patch.slots_mut()[place];
        (slot.trace, slot.remembered) = (trace, trace.ahead(memory.step()));
    }

    /// Has each slot remember how far the forces of this tick move it.
    pub(super) fn keep_traces(&mut self, memories: &Memories) {
        let motions = &self.motions;
        for slot in self.patch.slots_mut() {
            let body = usize::from(slot.body);
            let step = memories[body].step();
            if !step.is_none() {
                let moved = slot.moved - motions[body].at(slot.arm);
                let moved = (moved - slot.remembered) * step.at_once();
                slot.trace.advance(step, moved);
            }
        }
    }
}
