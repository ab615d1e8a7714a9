//! All tools in one tick: one problem of contact, with the points beside them.

pub(super) mod easing;
mod pace;
mod responses;

use glam::DVec3;

use crate::algebra::MOST_POINTS;
use crate::contact::ground::{Ground, MOST_BODIES, MOST_TOOLS, Memories};
use crate::contact::mobility::{Mobility, Motion};
use crate::fingers::press::{Answers, Presses};
use crate::fingers::several::Several;
use crate::tool::coefficients::AllPosed;
use crate::tool::collider::{Collider, Felt};
use crate::tool::complementarity::Complementarity;
use crate::tool::effort::Effort;
use crate::tool::friction::{Rubbing, take_anchors};
use crate::tool::patch::Patch;
use crate::tool::shape::Pose;
use crate::tool::slot::Slot;

use easing::Easing;
pub(super) use pace::Pace;
use responses::Influence;

/// Points of a tool that may enter in one tick.
pub(super) const MOST_ENTERING: usize = 24;

/// A tool and where it is to go in a tick.
pub struct Led<'a> {
    /// The tool.
    pub collider: &'a mut Collider,
    /// Where to.
    pub goal: Pose,
    /// From 0 to 1 after it was lifted by a fault: how much it presses.
    pub presence: f64,
}

/// All tools: those of fingers by their numbers, then supports.
pub type AllLed<'a> = [Option<Led<'a>>; MOST_TOOLS];

/// The points beside the tools.
pub(super) struct Beside<'a> {
    pub several: &'a mut Several,
    pub presses: &'a Presses,
    /// What the bodies remember.
    pub memories: &'a Memories,
    /// What became of them, once it is found.
    pub answers: Option<Answers>,
}

/// The contact of all tools, from tick to tick. Allocates all it ever needs.
#[derive(Debug, Clone)]
pub struct Joint {
    pub(super) patch: Patch,
    pub(super) problem: Complementarity,
    pub(super) rubbing: Rubbing,
    pub(super) influence: Influence,
    /// Which slot each unknown belongs to.
    pub(super) chosen: Vec<usize>,
    /// What points enter, nearest first.
    pub(super) entering: Vec<(f64, u32)>,
    pub(super) effort: Effort,
    /// What a tick may take.
    pub(super) pace: Pace,
    pub(super) easing: Easing,
    /// So far.
    pub(super) ticks: u32,
    /// Whose slots there are.
    eras: [Option<u64>; MOST_TOOLS],
    bodies: [Option<u32>; MOST_BODIES],
    /// How the bodies moved as a whole in the last tick.
    pub(super) mobilities: [Option<Mobility>; MOST_BODIES],
    pub(super) motions: [Motion; MOST_BODIES],
    /// Tools that have the same contact points, by body.
    pub(super) kin: [[[bool; MOST_TOOLS]; MOST_TOOLS]; MOST_BODIES],
}

impl Default for Joint {
    fn default() -> Self {
        Self {
            patch: Patch::new(),
            problem: Complementarity::default(),
            rubbing: Rubbing::new(),
            influence: Influence::new(),
            chosen: Vec::with_capacity(MOST_POINTS),
            entering: Vec::with_capacity(MOST_ENTERING + 1),
            effort: Effort::default(),
            pace: Pace::IN_TICK,
            easing: Easing::default(),
            ticks: 0,
            eras: [None; MOST_TOOLS],
            bodies: [None; MOST_BODIES],
            mobilities: [None; MOST_BODIES],
            motions: [Motion::default(); MOST_BODIES],
            kin: [[[false; MOST_TOOLS]; MOST_TOOLS]; MOST_BODIES],
        }
    }
}

impl Joint {
    /// One tick: all tools go towards their goals by at most one stride, and feel the bodies, each other
    /// and the points there.
    pub(super) fn tick(
        &mut self,
        grounds: &[Ground<'_>],
        led: &mut AllLed<'_>,
        beside: &mut Beside<'_>,
    ) {
        self.effort = Effort::default();
        self.begin(grounds, led);
        self.set_moving(grounds);
        self.offset(grounds, beside);
        let mut all_in = [true; MOST_TOOLS];
        for (number, all_in) in all_in.iter_mut().enumerate() {
            for body in 0..grounds.len() {
                if self.eras[number].is_some() {
                    *all_in &= self.choose([number as u8, body as u8], grounds, led, beside);
                }
            }
        }
        // Slots have gone and come.
        self.find_influence(grounds, beside);
        let posed = self.posed(led);
        let (linearisations, exact) = self.settle(grounds, led, &posed, beside);
        self.find_motions(grounds, beside);
        self.keep_traces(beside.memories);
        let mut are_numbers = self.patch.slots().iter().all(|slot| slot.moved.is_finite());
        // What presses is found by the numbers of slots: none goes before all tools have felt.
        let mut lets_go = [false; MOST_TOOLS];
        for (number, tool) in posed.iter().enumerate() {
            let (Some(tool), Some(led)) = (tool, &mut led[number]) else {
                continue;
            };
            led.collider.begin_taking();
            let mut felt = Felt {
                linearisations,
                exact: exact && all_in[number],
                effort: self.effort,
                ..Felt::default()
            };
            let mut nearest = [None; MOST_BODIES];
            for (body, ground) in grounds.iter().enumerate() {
                let pair = [number as u8, body as u8];
                let stuck = take_anchors(&mut self.patch, pair, tool);
                self.feel(pair, led.collider, ground.young_modulus, stuck, &mut felt);
            }
            for slot in self
                .patch
                .slots()
                .iter()
                .filter(|slot| usize::from(slot.tool) == number)
            {
                let nearest = &mut nearest[usize::from(slot.body)];
                if nearest.is_none_or(|other: &Slot| slot.seen.0 < other.seen.0) {
                    *nearest = Some(slot);
                }
            }
            are_numbers &= felt.force.is_finite() && felt.torque.is_finite();
            lets_go[number] = led.collider.feel(felt, nearest);
        }
        self.patch.let_go(|slot| lets_go[usize::from(slot.tool)]);
        if !are_numbers {
            for tool in led.iter_mut().flatten() {
                tool.collider.fail();
            }
        }
        self.move_on();
    }

    /// Tools take their way; slots of those that are not there any more, or feel nothing, go.
    fn begin(&mut self, grounds: &[Ground<'_>], led: &mut AllLed<'_>) {
        let mut eras = [None; MOST_TOOLS];
        for (era, tool) in eras.iter_mut().zip(led.iter_mut()) {
            let Some(Led {
                collider,
                goal,
                presence,
            }) = tool
            else {
                continue;
            };
            let feels = collider.go(goal) && *presence > 0.0;
            if feels {
                *era = Some(collider.era());
            } else if collider.felt().is_ok() {
                collider.clear();
            }
        }
        for (number, (before, now)) in self.eras.iter().zip(&eras).enumerate() {
            if before.is_some() && before != now {
                self.patch.let_go(|slot| usize::from(slot.tool) == number);
            }
        }
        self.eras = eras;
        for (body, (kin, number)) in self.kin.iter_mut().zip(&mut self.bodies).enumerate() {
            let now = grounds.get(body).map(|ground| ground.number);
            if *number != now {
                *number = now;
                self.patch.let_go(|slot| usize::from(slot.body) == body);
            }
            let surface = |tool: usize| led[tool].as_ref()?.collider.surface(body);
            for (p, kin) in kin.iter_mut().enumerate() {
                for (q, is_kin) in kin.iter_mut().enumerate() {
                    *is_kin =
                        matches!((surface(p), surface(q)), (Some(p), Some(q)) if p.is_same(q));
                }
            }
        }
    }

    /// The tools that feel the bodies, where they are.
    fn posed(&self, led: &AllLed<'_>) -> AllPosed {
        let mut posed = [None; MOST_TOOLS];
        for (number, posed) in posed.iter_mut().enumerate() {
            let led = led[number].as_ref().filter(|_| self.eras[number].is_some());
            *posed = led.and_then(|led| led.collider.posed());
        }
        posed
    }

    /// Whether nothing is near any tool.
    pub fn is_idle(&self) -> bool {
        self.patch.slots().is_empty()
    }

    /// How far tools move a place of the surface by their last forces, m.
    pub(super) fn moved_by_tools(
        &mut self,
        (body, ground): (usize, &Ground<'_>),
        led: &AllLed<'_>,
        nodes: [u32; 3],
        alpha: [f64; 3],
        counts: impl Fn(usize) -> bool,
    ) -> DVec3 {
        let mut moved = DVec3::ZERO;
        for (number, tool) in led.iter().enumerate() {
            let Some(tool) = tool.as_ref().filter(|_| counts(number)) else {
                continue;
            };
            for &(loaded, force) in tool.collider.nodal_forces(body) {
                for (node, weight) in nodes.into_iter().zip(alpha) {
                    if weight != 0.0 {
                        let block = self.patch.blocks_mut().get(ground, node, loaded);
                        moved += block * force * weight;
                    }
                }
            }
        }
        moved
    }
}
