//! All tools on a body in one tick: one problem of contact, with the points beside them.

use glam::DVec3;

use crate::algebra::MOST_POINTS;
use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::fingers::press::{Answers, Presses};
use crate::fingers::several::Several;
use crate::tool::coefficients::AllPosed;
use crate::tool::collider::{Collider, Felt};
use crate::tool::complementarity::Complementarity;
use crate::tool::effort::Effort;
use crate::tool::friction::{Rubbing, take_anchors};
use crate::tool::patch::Patch;
use crate::tool::shape::Pose;

use super::responses::Influence;

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

/// All tools, by the number of their finger.
pub type AllLed<'a> = [Option<Led<'a>>; MAX_FINGERS];

/// What a tick is on.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// The body.
    pub body: &'a Body,
    /// Counts the exchanges of the body.
    pub number: u32,
    /// Pa.
    pub young_modulus: f64,
    /// Length of the tick, s.
    pub dt: f64,
}

/// The points beside the tools.
pub(super) struct Beside<'a> {
    pub several: &'a mut Several,
    pub presses: &'a Presses,
    /// What became of them, once it is found.
    pub answers: Option<Answers>,
}

/// The contact of all tools on a body, from tick to tick. Allocates all it ever needs.
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
    /// Whose slots there are.
    eras: [Option<u64>; MAX_FINGERS],
    body: u32,
    /// Tools that have the same contact points.
    pub(super) kin: [[bool; MAX_FINGERS]; MAX_FINGERS],
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
            eras: [None; MAX_FINGERS],
            body: 0,
            kin: [[false; MAX_FINGERS]; MAX_FINGERS],
        }
    }
}

impl Joint {
    /// One tick: all tools go towards their goals by at most one stride, and feel the body, each other
    /// and the points there.
    pub(super) fn tick(
        &mut self,
        ground: &Ground<'_>,
        led: &mut AllLed<'_>,
        beside: &mut Beside<'_>,
    ) {
        self.effort = Effort::default();
        self.begin(ground, led);
        self.offset(ground, beside);
        let mut all_in = [true; MAX_FINGERS];
        for (number, all_in) in all_in.iter_mut().enumerate() {
            if self.eras[number].is_some() {
                *all_in = self.choose(number as u8, ground, led, beside);
            }
        }
        // Slots have gone and come.
        self.find_influence(ground.body, beside);
        let posed = self.posed(led);
        let (linearisations, exact) = self.settle(ground, led, &posed, beside);
        let mut are_numbers = self.patch.slots().iter().all(|slot| slot.moved.is_finite());
        for (number, tool) in posed.iter().enumerate() {
            let (Some(tool), Some(led)) = (tool, &mut led[number]) else {
                continue;
            };
            let stuck = take_anchors(&mut self.patch, number as u8, tool);
            let felt = Felt {
                linearisations,
                exact: exact && all_in[number],
                effort: self.effort,
                ..self.feel(number as u8, led.collider, ground.young_modulus, stuck)
            };
            are_numbers &= felt.force.is_finite() && felt.torque.is_finite();
            let own = (self.patch.slots().iter()).filter(|slot| usize::from(slot.tool) == number);
            let nearest = own.min_by(|a, b| a.seen.0.total_cmp(&b.seen.0));
            if led.collider.feel(felt, nearest) {
                self.patch.let_go(number as u8);
            }
        }
        if !are_numbers {
            for tool in led.iter_mut().flatten() {
                tool.collider.fail();
            }
        }
    }

    /// Tools take their way; slots of those that are not there any more, or feel nothing, go.
    fn begin(&mut self, ground: &Ground<'_>, led: &mut AllLed<'_>) {
        let mut eras = [None; MAX_FINGERS];
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
                self.patch.let_go(number as u8);
            }
        }
        self.eras = eras;
        if self.body != ground.number {
            self.body = ground.number;
            self.patch.turn_to(ground.number);
        }
        for (p, kin) in self.kin.iter_mut().enumerate() {
            for (q, is_kin) in kin.iter_mut().enumerate() {
                *is_kin = matches!((&led[p], &led[q]), (Some(p), Some(q))
                    if p.collider.surface().is_same(q.collider.surface()));
            }
        }
    }

    /// The tools that feel the body, where they are.
    fn posed(&self, led: &AllLed<'_>) -> AllPosed {
        let mut posed = [None; MAX_FINGERS];
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
        body: &Body,
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
            for &(loaded, force) in tool.collider.nodal_forces() {
                for (node, weight) in nodes.into_iter().zip(alpha) {
                    if weight != 0.0 {
                        let block = self.patch.blocks_mut().get(body, node, loaded);
                        moved += block * force * weight;
                    }
                }
            }
        }
        moved
    }
}
