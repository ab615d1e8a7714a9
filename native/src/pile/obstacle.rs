//! A rigid tool that bodies meet: a floor, a support, a finger.

use crate::tool::shape::{Pose, Tool};

/// A rigid tool, where it is and where it goes.
#[derive(Debug, Clone)]
pub struct Obstacle {
    /// Its shape.
    pub tool: Tool,
    /// In the world.
    pub pose: Pose,
    /// Where it goes, by a stride a tick.
    pub goal: Pose,
    /// Coulomb's coefficient.
    pub friction: f64,
}

impl Obstacle {
    /// One that stays where it is.
    pub fn new(tool: Tool, pose: Pose, friction: f64) -> Self {
        Self {
            tool,
            pose,
            goal: pose,
            friction,
        }
    }

    /// Goes a stride, `most` m at most.
    pub(super) fn go(&mut self, most: f64) {
        let (way, turn) = self.pose.way_to(&self.goal);
        let length = way.length() + turn.length() * self.tool.reach();
        let share = most.min(self.tool.stride()) / length;
        if share >= 1.0 || length == 0.0 {
            self.pose = self.goal;
            return;
        }
        let turned = glam::DQuat::from_scaled_axis(turn * share);
        self.pose.position += way * share;
        self.pose.rotation = glam::DMat3::from_quat(turned) * self.pose.rotation;
    }

    /// Whether it is where it goes.
    pub(super) fn is_there(&self) -> bool {
        self.pose == self.goal
    }
}
