//! A body that nobody holds, with tools on it and no clock: ticks of any length, until it rests.

use std::sync::Arc;

use glam::DVec3;

use super::finger::Finger;
use super::placement::Placement;
use super::prop::Prop;
pub use super::settling::Restless;
use super::settling::Settles;
use crate::contact::cones::{MAX_FINGERS, mean};
use crate::contact::ground::{Ground, MOST_TOOLS};
use crate::contact::mobility::Motion;
use crate::creep::step::Step;
use crate::engine::Engine;
use crate::engine::joint::AllLed;
use crate::tool::collider::Collider;

/// Ticks on the way to rest are so long at most that a force takes the body as a whole so many times as
/// far as it presses in what it acts on. Friction is found in sweeps over points, which all move with
/// the body: longer ticks would end before it is.
const LONGEST: f64 = 100.0;
const LONGEST_RUBBING: f64 = 0.5;
/// While it goes by more than this share of its size in a millisecond, ticks may be as long as that.
const BRISK: f64 = 1e-4;
const MILLISECOND: f64 = 1e-3;
/// A body that nobody holds, and tools on it.
#[derive(Debug, Clone)]
pub struct Resting {
    young_modulus: f64,
    /// Where it is, and on what.
    pub prop: Prop,
    /// What presses it, by number.
    pub fingers: Vec<Finger>,
    engine: Engine,
    time: f64,
}

impl Resting {
    /// A body that touches nothing yet.
    pub fn new(young_modulus: f64, prop: Prop, fingers: Vec<Finger>) -> Self {
        debug_assert!(fingers.len() <= MAX_FINGERS);
        Self {
            young_modulus,
            prop,
            fingers,
            engine: Engine::default(),
            time: 0.0,
        }
    }

    /// Pa.
    pub fn young_modulus(&self) -> f64 {
        self.young_modulus
    }

    /// Another one, from the next tick on, Pa.
    pub fn set_young_modulus(&mut self, young_modulus: f64) {
        self.young_modulus = young_modulus;
    }

    /// Lays the body elsewhere: all that touches it is set down anew.
    pub fn place(&mut self, placement: Placement) {
        self.prop.placement = placement;
        self.fingers.iter_mut().for_each(Finger::lift);
        let supports = self.prop.supports.iter_mut();
        supports.for_each(|support| support.collider.lift());
    }

    /// Since it was set down, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The elastic energy in it, J.
    pub fn elastic(&self) -> f64 {
        let by_points = self.fingers.iter().map(|finger| match finger {
            Finger::Tool(..) => 0.0,
            Finger::Point(point) => point.energy,
        });
        (self.engine.elastic(0) + by_points.sum::<f64>()) * self.young_modulus
    }

    /// All forces on the body, N, and their torque about its centre of mass, N m, as the last tick found
    /// them; in its frame, without its weight.
    pub fn wrench(&self) -> (DVec3, DVec3) {
        let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        let by_fingers = self
            .fingers
            .iter()
            .flat_map(|finger| finger.pushes(&self.prop.body));
        let by_supports = self.prop.supports.iter();
        let by_supports = by_supports.flat_map(|support| support.collider.pressed());
        let by_supports = by_supports.map(|slot| (slot.arm, slot.force));
        for (place, push) in by_fingers.chain(by_supports) {
            let push = push * self.young_modulus;
            force += push;
            torque += (place - self.prop.free.centre).cross(push);
        }
        (force, torque)
    }

    fn colliders(&self) -> impl Iterator<Item = &Collider> {
        let supports = self.prop.supports.iter().map(|support| &support.collider);
        self.fingers.iter().filter_map(Finger::tool).chain(supports)
    }

    /// One tick of `dt` s: how the body moved, in its frame. A hurried one is bounded like the servo's.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    pub fn tick(&mut self, dt: f64, is_hurried: bool) -> Result<Motion, Restless> {
        self.engine.set_hurried(is_hurried);
        let body = Arc::clone(&self.prop.body);
        let mobility = self.prop.mobility(self.young_modulus, dt);
        let ground = Ground {
            body: &body,
            number: 0,
            young_modulus: self.young_modulus,
            mobility: Some(mobility),
            creep: Step::default(),
        };
        let mut led: AllLed<'_> = [const { None }; MOST_TOOLS];
        let placement = self.prop.placement;
        let mut presses = [None; MAX_FINGERS];
        for (number, finger) in self.fingers.iter_mut().enumerate() {
            presses[number] = finger.press(&body, &placement);
            led[number] = finger.lead(&placement);
        }
        self.prop.lead(&mut led);
        let answers = self.engine.tick(&[ground], &presses, &mut led);
        if answers.is_none() && presses.iter().any(Option::is_some) {
            return Err(Restless::NotANumber);
        }
        for (finger, answer) in self.fingers.iter_mut().zip(answers.iter().flatten()) {
            finger.take(answer);
        }
        let motion = self.engine.motion(0);
        if !motion.is_finite() || self.colliders().any(|tool| tool.felt().is_err()) {
            return Err(Restless::NotANumber);
        }
        self.prop.move_on(&motion);
        self.time += dt;
        Ok(motion)
    }

    /// Whether tools and supports are where they are to be, but for a share of the body's size.
    pub(super) fn are_at_goals(&self, share: f64) -> bool {
        let placement = &self.prop.placement;
        let supports = self.prop.supports.iter();
        let supports = supports.map(|support| (&support.collider, &support.pose));
        let tools = self.fingers.iter().filter_map(|finger| match finger {
            Finger::Tool(tool, pose) => Some((&**tool, pose)),
            Finger::Point(_) => None,
        });
        tools.chain(supports).all(|(tool, goal)| {
            tool.pose().is_some_and(|pose| {
                let (way, turn) = pose.way_to(&placement.to_body(goal));
                way.length() <= share * self.prop.body.size() && turn.length() <= share
            })
        })
    }

    /// Forces on all fingers and supports, N.
    pub(super) fn wrenches(&self) -> Vec<DVec3> {
        let fingers = self
            .fingers
            .iter()
            .map(|finger| finger.force(self.young_modulus));
        let supports = self.prop.supports.iter().map(|support| &support.collider);
        let felt = |tool: &Collider| tool.felt().map_or(DVec3::NAN, |felt| felt.force);
        fingers.chain(supports.map(felt)).collect()
    }
}

impl Settles for Resting {
    fn go(&mut self, dt: f64) -> Result<f64, Restless> {
        let motion = self.tick(dt, false)?;
        Ok(motion.most(self.prop.body.size()))
    }

    fn longest_tick(&self) -> f64 {
        let blocks = self.prop.body.contact_blocks.iter();
        let stiffness: f64 = blocks.map(mean).sum();
        let gives = self.prop.body.nodes.len() as f64 / (stiffness * self.young_modulus);
        let has_points = self.fingers.iter().any(|finger| finger.tool().is_none());
        let rubs = has_points || self.colliders().any(Collider::rubs);
        let times = if rubs { LONGEST_RUBBING } else { LONGEST };
        times * gives * self.prop.free.mass / self.prop.free.drag_time
    }

    fn longest_at(&self, longest: f64, speed: f64) -> f64 {
        if speed * MILLISECOND > BRISK * self.prop.body.size() {
            longest.max(MILLISECOND)
        } else {
            longest
        }
    }

    fn forces(&self) -> Vec<DVec3> {
        self.wrenches()
    }

    fn weight(&self) -> f64 {
        (self.prop.gravity * self.prop.free.mass).length()
    }

    fn left(&self) -> f64 {
        let gravity = (self.prop.placement).direction_to_body(self.prop.gravity);
        let (force, torque) = self.wrench();
        let wrench = (force + gravity * self.prop.free.mass, torque);
        let (force, torque) = self.prop.free.untaken(gravity, wrench);
        force.length().max(torque.length() / self.prop.body.size())
    }

    fn is_led(&self, share: f64) -> bool {
        self.are_at_goals(share)
    }

    fn spacing(&self) -> f64 {
        let surfaces = self.colliders().filter_map(|tool| tool.surface(0));
        surfaces.fold(self.prop.body.size(), |least, surface| {
            least.min(surface.spacing())
        })
    }

    fn size(&self) -> f64 {
        self.prop.body.size()
    }

    fn since(&self) -> f64 {
        self.time
    }

    fn placements(&self) -> Vec<Placement> {
        vec![self.prop.placement]
    }

    fn mobility(&self) -> f64 {
        self.prop.free.drag_time / self.prop.free.mass
    }
}
