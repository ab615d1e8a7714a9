//! All that touches some bodies at once, as one problem of contact: for the tick, and for whoever has no
//! clock.
//!
//! Tools are [`Led`](joint::Led) to where they are to go, points say where they press; what presses is
//! found for all together, with what was found in the tick before to begin with.

mod choose;
mod equilibrium;
mod feel;
pub mod goals;
mod influence;
pub mod joint;
pub mod lone;
mod moving;
mod remembering;
pub mod settling;
mod stillness;

use crate::contact::ground::{Ground, Memories};
use crate::contact::mobility::Motion;
use crate::fingers::press::{Answers, Presses, Reaction};
use crate::fingers::several::Several;
use joint::{AllLed, Beside, Joint, Pace};

/// The contact of all fingers, from tick to tick.
#[derive(Debug, Clone, Default)]
pub struct Engine {
    several: Several,
    joint: Joint,
    memories: Memories,
}

impl Engine {
    /// One tick on a list of bodies: what becomes of the points, and each tool keeps what it felt. `None` where there are no
    /// points, on a body that does not keep its whole compliance, or where rounding has made nonsense
    /// of it.
    pub fn tick(
        &mut self,
        grounds: &[Ground<'_>],
        presses: &Presses,
        led: &mut AllLed<'_>,
    ) -> Option<Answers> {
        for (memory, ground) in self.memories.iter_mut().zip(grounds) {
            memory.begin(ground.number, &ground.creep);
        }
        let presses = &(self.joint).recalled(grounds, presses, &self.memories);
        let mut answers = self.solve(grounds, presses, led);
        if let Some(answers) = &mut answers {
            self.joint.take_motions(grounds, presses, answers);
        }
        let memories = &mut self.memories;
        remembering::end(memories, grounds, presses, answers.as_ref(), led);
        answers
    }

    /// What the bodies remember of past forces, by number in the list.
    pub fn memories(&self) -> &Memories {
        &self.memories
    }

    fn solve(
        &mut self,
        grounds: &[Ground<'_>],
        presses: &Presses,
        led: &mut AllLed<'_>,
    ) -> Option<Answers> {
        let has_points = presses.iter().any(Option::is_some);
        if !has_points {
            self.several.release();
        }
        let are_held = grounds.iter().all(|ground| ground.mobility.is_none());
        if led.iter().all(Option::is_none) && self.joint.is_idle() && are_held {
            let none = Reaction::default();
            return has_points.then(|| self.several.solve(grounds, presses, &none))?;
        }
        let mut beside = Beside {
            several: &mut self.several,
            presses,
            memories: &self.memories,
            answers: None,
        };
        self.joint.tick(grounds, led, &mut beside);
        beside.answers
    }

    /// Whether ticks from now on are bounded as one of 1 kHz has to be, or take what they need.
    pub fn set_hurried(&mut self, is_hurried: bool) {
        self.joint.pace = if is_hurried {
            Pace::IN_TICK
        } else {
            Pace::UNHURRIED
        };
    }

    /// How a body that nobody holds moved as a whole in the last tick, in its own frame.
    pub fn motion(&self, body: usize) -> Motion {
        self.joint.motion(body)
    }

    /// The elastic energy that tools held in a body in the last tick, J at unit modulus.
    pub fn elastic(&self, body: usize) -> f64 {
        self.joint.elastic(body)
    }
}
