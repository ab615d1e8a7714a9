//! A finger: a device, what it touches with, and what it keeps from tick to tick.
//!
//! The servo leads all fingers through the stages of a tick, one stage after the other. Each stage makes
//! a value of those of the stages before: `read` a [`Reading`], `follow` a [`Followed`], `feel` a
//! [`Touch`], `send` the [`Snapshot`](crate::servo::snapshot::Snapshot).

mod among;
mod follow;
mod inspection;
mod output;
mod point;
mod tool;
mod touch;

use glam::{DMat3, DVec3};
use triple_buffer::Input;

use crate::control::coupling::Coupler;
use crate::control::safety::Safety;
use crate::control::state::Standing;
use crate::device::{Device, Reading};
use crate::fingers::press::{Answer, Press};
use crate::servo::pressed_patch::PressedPatch;
use crate::servo::settings::{FingerSettings, Moment};
use crate::servo::snapshot::FingerReport;
use crate::servo::tip::{Tip, TipHolder, exchange_tips};
use crate::tool::shape::Pose;
pub use follow::Followed;
use point::Point;
use tool::ToolTouch;
pub use touch::Touch;

/// A finger.
pub struct Finger {
    /// What moves it.
    pub device: Box<dyn Device>,
    /// What it touches with.
    pub tips: TipHolder,
    /// Where the patch of a tool is shown.
    pub patches: Option<Input<PressedPatch>>,
    /// The last that is known.
    pose: Pose,
    frame_epoch: u32,
    /// Time of the last tick after a gap, s.
    interrupted_at: f64,
    /// From 0 to 1 after a fault: how much it acts on the others.
    presence: f64,
    point: Point,
    tool: ToolTouch,
    coupler: Coupler,
    safety: Safety,
    standing: Standing,
    report: FingerReport,
}

impl Finger {
    /// A finger at rest.
    pub fn new(device: Box<dyn Device>, settings: &FingerSettings) -> Self {
        Self {
            device,
            tips: exchange_tips(Tip::Point).1,
            patches: None,
            pose: Pose {
                position: DVec3::ZERO,
                rotation: DMat3::IDENTITY,
            },
            frame_epoch: settings.frame.epoch,
            interrupted_at: f64::NEG_INFINITY,
            presence: 1.0,
            point: Point::fresh(),
            tool: ToolTouch::default(),
            coupler: Coupler::default(),
            safety: Safety::default(),
            standing: Standing::default(),
            report: FingerReport::default(),
        }
    }

    /// Asks the device where it is.
    pub fn read(&mut self, moment: &Moment<'_>, own: &FingerSettings) -> Reading {
        self.device.read(moment.now, moment.dt, &own.frame)
    }

    /// Whether it has to reckon with what others do or did.
    pub fn is_moved(&self) -> bool {
        self.point.among.is_moved()
    }

    /// Whether its tip is a tool.
    pub fn has_tool(&self) -> bool {
        matches!(self.tips.tip, Tip::Tool(_))
    }

    /// The finger as the others see it, unless its tip is a tool.
    pub fn press(&mut self, followed: &Followed<'_>) -> Option<Press> {
        let is_point = !self.has_tool();
        is_point.then(|| self.point.press(followed))?
    }

    /// The contact of the finger, alone or with what the others make of it.
    pub fn feel(&mut self, followed: &Followed<'_>, answer: Option<&Answer>) -> Touch {
        let coupler = &mut self.coupler;
        let touch = match &self.tips.tip {
            Tip::Tool(tool) => self.tool.feel(followed, tool, coupler),
            Tip::Point => self.point.feel(followed, answer, coupler),
        };
        if !touch.found.touching {
            self.point.blend.let_go();
            // In a tick without a position nobody knows, and the coupling waits.
            if followed.motors.is_some() {
                self.coupler.release();
            }
        }
        touch
    }
}
