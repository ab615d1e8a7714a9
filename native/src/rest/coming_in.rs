//! How a body that rested elsewhere, or before, goes on from there.

use super::finger::Finger;
use super::resting::Resting;
use super::settling::{AT_GOAL, Restless, SHORTEST, Settles, have_stayed};

/// What comes in does so in ticks that are so short beside the shortest others.
const INSTANT: f64 = 1e-3;
/// Strides in which they come in at most, and so many when they are there: friction may go to and fro for ever
/// between two ways to hold the body.
const MOST_STRIDES_IN: usize = 2000;
const MOST_THERE: usize = 30;

impl Resting {
    /// What overlaps the body where it lies comes in from outside, while the body stays there: so a
    /// body goes on from where it rested.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    pub fn come_in(&mut self) -> Result<(), Restless> {
        let placement = self.prop.placement;
        let tools = self.fingers.iter_mut().filter_map(|finger| match finger {
            Finger::Tool(tool, pose) => Some((&mut **tool, &*pose)),
            Finger::Point(_) => None,
        });
        let supports = self.prop.supports.iter_mut();
        let supports = supports.map(|support| (&mut support.collider, &support.pose));
        for (tool, pose) in tools.chain(supports) {
            if let Some(outside) = tool.way_out(&placement.to_body(pose)) {
                tool.restart(&outside);
            }
        }
        let instant = INSTANT * SHORTEST * self.longest_tick();
        let (mut before, mut there) = (self.wrenches(), 0);
        for _ in 0..MOST_STRIDES_IN {
            self.tick(instant, false)?;
            self.prop.placement = placement;
            let now = self.wrenches();
            there += usize::from(self.are_at_goals(AT_GOAL));
            if there == MOST_THERE || (there > 0 && have_stayed(&before, &now)) {
                break;
            }
            before = now;
        }
        Ok(())
    }
}
