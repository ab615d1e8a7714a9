//! A finger: a device, what it touches with, and what it keeps from tick to tick.
//!
//! The servo leads all fingers through the stages of a tick, one stage after the other. Each stage makes
//! a value of those of the stages before: `read` a [`Reading`], `follow` a [`Followed`], `feel` a
//! [`Touch`], which the servo's toll brakes, `send` the [`Snapshot`](crate::servo::snapshot::Snapshot).

mod among;
mod follow;
mod followed;
mod inspection;
mod loose;
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
use crate::engine::joint::Led;
use crate::fingers::press::{Answer, Press};
use crate::servo::exchange::rings::Taker;
use crate::servo::pressed_patch::PressedPatch;
use crate::servo::settings::{FingerSettings, Moment};
use crate::servo::snapshot::FingerReport;
use crate::servo::tip::Tip;
use crate::tool::coefficients::Friction;
use crate::tool::shape::Pose;
pub use followed::Followed;
use point::Point;
use tool::ToolTouch;
pub use touch::Touch;

/// A finger.
pub struct Finger {
    /// What moves it.
    device: Box<dyn Device>,
    /// What it touches with.
    pub tips: Taker<Tip>,
    /// Where the patch of a tool is shown.
    patches: Input<PressedPatch>,
    /// The last that is known, as the hand has it.
    pose: Pose,
    frame_epoch: u32,
    /// Time of the last tick after a gap, s.
    interrupted_at: f64,
    /// Time for which the device has been too fast without a break, s.
    fast_for: f64,
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
    pub fn new(
        device: Box<dyn Device>,
        tips: Taker<Tip>,
        patches: Input<PressedPatch>,
        settings: &FingerSettings,
    ) -> Self {
        Self {
            device,
            tips,
            patches,
            pose: Pose {
                position: DVec3::ZERO,
                rotation: DMat3::IDENTITY,
            },
            frame_epoch: settings.frame.epoch,
            interrupted_at: f64::NEG_INFINITY,
            fast_for: 0.0,
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
        matches!(self.tips.held, Tip::Tool(_))
    }

    /// The finger as the others see it, unless its tip is a tool.
    pub fn press(&mut self, followed: &Followed<'_>) -> Option<Press> {
        let is_point = !self.has_tool();
        is_point.then(|| self.point.press(followed))?
    }

    /// The tool and where it is to go, if the finger has one and knows where it is. Beside others, and
    /// on a body that it may move, it presses as far as it is present.
    pub fn lead(&mut self, followed: &Followed<'_>, is_beside: bool) -> Option<Led<'_>> {
        let Tip::Tool(tool) = &mut self.tips.held else {
            return None;
        };
        if !followed.is_sound {
            return None;
        }
        let feel = &followed.moment.settings.feel;
        tool.set_friction(Friction {
            sticking: feel.static_friction,
            slipping: feel.dynamic_friction,
        });
        Some(Led {
            collider: tool,
            goal: followed.pose,
            presence: if is_beside { self.presence } else { 1.0 },
        })
    }

    /// The contact of the finger, alone or with what the others make of it.
    pub fn feel(&mut self, followed: &Followed<'_>, answer: Option<&Answer>) -> Touch {
        let coupler = &mut self.coupler;
        let touch = match &self.tips.held {
            Tip::Tool(tool) => self.tool.feel(followed, tool, coupler),
            Tip::Point => self.point.feel(followed, answer, coupler),
        };
        if !touch.found.touching {
            // In a tick without a position nobody knows, and the coupling waits.
            if followed.motors.is_some() {
                self.coupler.release();
            }
        }
        touch
    }
}
