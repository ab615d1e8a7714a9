//! A rigid tool that bodies meet: a floor, a support, a finger.

use super::contact::{Against, Contact};
use crate::tool::coefficients::Friction;
use crate::tool::shape::{Pose, Tool};

/// A rigid tool in a tick.
#[derive(Debug, Clone, Copy)]
pub struct Rigid<'a> {
    /// Its shape.
    pub tool: &'a Tool,
    /// In the world.
    pub pose: Pose,
    /// Coulomb's.
    pub friction: Friction,
    /// From 0 to 1 after it was lifted by a fault: how much it presses.
    pub presence: f64,
    /// Whether it is led by a hand, for which there may be closer points.
    pub is_hand: bool,
}

/// All that is rigid in a tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct Around<'a> {
    /// Tools that hands lead, by number.
    pub fingers: &'a [Option<Rigid<'a>>],
    /// Others.
    pub obstacles: &'a [Obstacle],
}

impl<'a> Around<'a> {
    /// What a contact's point meets, if that is rigid and there.
    #[inline]
    pub fn of(&self, against: Against) -> Option<Rigid<'a>> {
        match against {
            Against::Finger(number) => *self.fingers.get(number)?,
            Against::Obstacle(number) => self.obstacles.get(number).map(Obstacle::rigid),
            Against::Body(_) => None,
        }
    }

    /// Coulomb's coefficient of a contact, none before it has stuck; `between` is that of two bodies.
    #[inline]
    pub fn coefficient(&self, contact: &Contact, between: f64) -> f64 {
        match (contact.anchor, contact.against) {
            (None, _) => 0.0,
            (_, Against::Body(_)) => between,
            (_, against) => self
                .of(against)
                .map_or(0.0, |r| r.friction.of_one(contact.slips)),
        }
    }

    /// All of them.
    pub fn all(&self) -> impl Iterator<Item = (Against, Rigid<'a>)> + use<'a> {
        let fingers = self.fingers.iter().enumerate();
        let fingers = fingers.filter_map(|(number, one)| Some((Against::Finger(number), (*one)?)));
        let others = self.obstacles.iter().enumerate();
        let others = others.map(|(number, one)| (Against::Obstacle(number), one.rigid()));
        fingers.chain(others)
    }
}

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
    /// Whether it presses, and does not bear.
    pub is_hand: bool,
}

impl Obstacle {
    /// One that stays where it is.
    pub fn new(tool: Tool, pose: Pose, friction: f64, is_hand: bool) -> Self {
        Self {
            tool,
            pose,
            goal: pose,
            friction,
            is_hand,
        }
    }

    #[inline]
    fn rigid(&self) -> Rigid<'_> {
        Rigid {
            tool: &self.tool,
            pose: self.pose,
            friction: Friction::of(self.friction),
            presence: 1.0,
            is_hand: self.is_hand,
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
