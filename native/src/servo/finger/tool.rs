//! A finger whose tip is a tool.

use glam::{DMat3, DVec3};

use super::{Finger, ToolTouch};
use crate::control::coupling::Contact;
use crate::device::Fault;
use crate::engine::joint::Led;
use crate::proxy::Feel;
use crate::servo::settings::FingerSettings;
use crate::servo::tip::Tip;
use crate::tool::coefficients::Friction;
use crate::tool::collider::Collider;
use crate::tool::shape::Pose;

/// The coupling sees a tool's stiffness smoothed over this time, s: it jumps where a point comes to
/// bear, which the force must not.
const STIFFNESS_SECONDS: f64 = 0.01;

impl Finger {
    /// The tool, if it has one.
    pub fn tool(&self) -> Option<&Collider> {
        match &self.tips.tip {
            Tip::Tool(tool) => Some(tool),
            Tip::Point => None,
        }
    }

    /// Whether its tip is a tool.
    pub fn has_tool(&self) -> bool {
        self.tool().is_some()
    }

    fn pose(&self) -> Pose {
        Pose {
            position: self.probe,
            rotation: self.shot.orientation,
        }
    }

    /// Sets the tool down where the finger is.
    pub(super) fn set_tool_down(&mut self) {
        let pose = self.pose();
        if let Tip::Tool(tool) = &mut self.tips.tip {
            tool.restart(&pose);
        }
    }

    /// The tool and where it is to go, if the finger has one and knows where it is. Among several it
    /// presses as far as it is present.
    pub fn lead(&mut self, feel: &Feel, are_several: bool) -> Option<Led<'_>> {
        let goal = self.pose();
        let is_sound = !self.found.blind && self.found.fault != Some(Fault::Nan) && self.tip_fits;
        let Tip::Tool(tool) = &mut self.tips.tip else {
            return None;
        };
        if !is_sound {
            return None;
        }
        tool.set_friction(Friction {
            sticking: feel.static_friction,
            slipping: feel.dynamic_friction,
        });
        Some(Led {
            collider: tool,
            goal,
            presence: if are_several { self.presence } else { 1.0 },
        })
    }

    /// What a tool feels that was led; what goes to the motors, N.
    pub fn feel_tool(&mut self, own: &FingerSettings, dt: f64) -> DVec3 {
        let is_sound = !self.found.blind && self.found.fault != Some(Fault::Nan) && self.tip_fits;
        let Tip::Tool(tool) = &self.tips.tip else {
            return DVec3::ZERO;
        };
        if !is_sound {
            self.let_go();
            return DVec3::ZERO;
        }
        let felt = match tool.felt() {
            Ok(felt) => *felt,
            Err(_) => {
                self.found.fault = self.found.fault.or(Some(Fault::Nan));
                self.let_go();
                return DVec3::ZERO;
            }
        };
        self.found.inside = !tool.is_free();
        if let Some(pose) = tool.pose() {
            self.shot.proxy = pose.position;
        }
        if felt.pressed == 0 {
            self.tool_touch = ToolTouch {
                begin: self.probe,
                stiffness: DMat3::ZERO,
            };
            self.let_go();
            return DVec3::ZERO;
        }
        self.found.touching = true;
        self.shot.touching = true;
        self.shot.contact_force = felt.force;
        self.shot.torque = felt.torque;
        if self.has_motors() {
            self.couple_tool(felt.force, felt.stiffness, own, dt)
        } else {
            felt.force
        }
    }

    /// The force of the body and the coupling's spring in series, damped.
    fn couple_tool(
        &mut self,
        force: DVec3,
        stiffness: DMat3,
        own: &FingerSettings,
        dt: f64,
    ) -> DVec3 {
        let touch = &mut self.tool_touch;
        touch.stiffness += (stiffness - touch.stiffness) * (dt / (STIFFNESS_SECONDS + dt));
        let scale = own.frame.scale;
        let contact = Contact {
            stiffness: touch.stiffness,
            displacement: self.probe - touch.begin,
            force,
        };
        let coupled = self.coupler.couple(&contact, &own.coupling, scale, dt);
        coupled.force
    }
}
