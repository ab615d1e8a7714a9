//! A body that nobody holds, with tools on it and no clock: ticks of any length, until it rests.

use std::sync::Arc;

use glam::DVec3;

use super::placement::Placement;
use super::prop::Prop;
use crate::body::surface::Body;
use crate::contact::cones::{MAX_FINGERS, mean};
use crate::contact::ground::{Ground, MOST_TOOLS};
use crate::contact::mobility::Motion;
use crate::creep::step::Step;
use crate::engine::Engine;
use crate::engine::joint::{AllLed, Led};
use crate::tool::collider::Collider;
use crate::tool::shape::Pose;

/// Ticks on the way to rest are so long at most that a force takes the body as a whole so many times as
/// far as it presses in what it acts on. Friction is found in sweeps over points, which all move with
/// the body: longer ticks would end before it is.
const LONGEST: f64 = 100.0;
const LONGEST_RUBBING: f64 = 0.5;
/// And this share of that at least.
const SHORTEST: f64 = 1e-3;
/// On the way to rest it moves by this share of the distance between contact points in a tick, about.
const WAY_PER_SPACING: f64 = 0.25;
/// While it goes by more than this share of its size in a millisecond, ticks may be as long as that.
const BRISK: f64 = 1e-4;
const MILLISECOND: f64 = 1e-3;
/// How often a tick takes up the work that one of the servo has to be done with.
const TURNS: usize = 20;
/// It rests when what is left of all wrenches is less than this share of the largest.
const AT_REST: f64 = 1e-8;
/// And forces change by less than this share of the largest.
const SETTLED: f64 = 1e-8;
/// In so many ticks one after the other.
const QUIET_TICKS: usize = 3;
/// Ticks that it is given, and how many times its size it may go meanwhile.
const MOST_TICKS: usize = 20_000;
const MOST_SIZES: f64 = 20.0;
/// Tools are at their goals if they miss them by this share of the body's size.
const AT_GOAL: f64 = 1e-9;
/// What comes in does so in ticks that are so short beside the shortest others.
const INSTANT: f64 = 1e-3;
/// Strides in which they come in at most.
const MOST_STRIDES_IN: usize = 2000;

/// Why a body does not rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Restless {
    /// A force is no number.
    NotANumber,
    /// After so many s it still moves at this speed, m/s.
    Moving(f64, f64),
}

/// A body that nobody holds, and tools on it.
#[derive(Debug, Clone)]
pub struct Resting {
    body: Arc<Body>,
    young_modulus: f64,
    /// Where it is, and on what.
    pub prop: Prop,
    /// Tools, by number, with their poses in the world.
    pub fingers: Vec<(Collider, Pose)>,
    engine: Engine,
    time: f64,
}

impl Resting {
    /// A body that touches nothing yet; at most as many tools as fingers.
    pub fn new(
        body: Arc<Body>,
        young_modulus: f64,
        prop: Prop,
        fingers: Vec<(Collider, Pose)>,
    ) -> Self {
        debug_assert!(fingers.len() <= MAX_FINGERS);
        Self {
            body,
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

    /// Lays the body elsewhere: all that touches it is set down anew.
    pub fn place(&mut self, placement: Placement) {
        self.prop.placement = placement;
        let tools = self.fingers.iter_mut().map(|(tool, _)| tool);
        let supports = self.prop.supports.iter_mut();
        let all = tools.chain(supports.map(|support| &mut support.collider));
        all.for_each(Collider::lift);
    }

    /// What overlaps the body where it lies comes in from outside, while the body stays there: so a
    /// body goes on from where it rested.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    pub fn come_in(&mut self) -> Result<(), Restless> {
        let placement = self.prop.placement;
        let tools = self.fingers.iter_mut().map(|(tool, pose)| (tool, pose));
        let supports = self.prop.supports.iter_mut();
        let supports = supports.map(|support| (&mut support.collider, &mut support.pose));
        for (tool, pose) in tools.chain(supports) {
            if let Some(outside) = tool.way_out(&placement.to_body(pose)) {
                tool.restart(&outside);
            }
        }
        let instant = INSTANT * SHORTEST * self.longest_tick();
        let mut before = self.wrenches();
        for _ in 0..MOST_STRIDES_IN {
            self.tick(instant, false)?;
            self.prop.placement = placement;
            let now = self.wrenches();
            if self.are_at_goals() && have_stayed(&before, &now) {
                break;
            }
            before = now;
        }
        Ok(())
    }

    /// Since it was set down, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The elastic energy in it, J.
    pub fn elastic(&self) -> f64 {
        self.engine.elastic(0) * self.young_modulus
    }

    /// All forces on the body, N, and their torque about its centre of mass, N m, as the last tick found
    /// them; in its frame, without its weight.
    pub fn wrench(&self) -> (DVec3, DVec3) {
        let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        for slot in self.colliders().flat_map(Collider::pressed) {
            let push = slot.force * self.young_modulus;
            force += push;
            torque += (slot.at.position - self.prop.free.centre).cross(push);
        }
        (force, torque)
    }

    fn colliders(&self) -> impl Iterator<Item = &Collider> {
        let supports = self.prop.supports.iter().map(|support| &support.collider);
        self.fingers.iter().map(|(tool, _)| tool).chain(supports)
    }

    /// One tick of `dt` s: how the body moved, in its frame. A hurried one is bounded like the servo's.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    pub fn tick(&mut self, dt: f64, is_hurried: bool) -> Result<Motion, Restless> {
        self.engine.set_turns(if is_hurried { 1 } else { TURNS });
        let mobility = self.prop.mobility(self.young_modulus, dt);
        let ground = Ground {
            body: &self.body,
            number: 0,
            young_modulus: self.young_modulus,
            mobility: Some(mobility),
            creep: Step::default(),
        };
        let mut led: AllLed<'_> = [const { None }; MOST_TOOLS];
        for (led, (collider, pose)) in led.iter_mut().zip(&mut self.fingers) {
            *led = Some(Led {
                goal: self.prop.placement.to_body(pose),
                collider,
                presence: 1.0,
            });
        }
        self.prop.lead(&mut led);
        let presses = [None; MAX_FINGERS];
        self.engine.tick(&[ground], &presses, &mut led);
        let motion = self.engine.motion(0);
        if !motion.is_finite() || self.colliders().any(|tool| tool.felt().is_err()) {
            return Err(Restless::NotANumber);
        }
        self.prop.move_on(&motion);
        self.time += dt;
        Ok(motion)
    }

    /// Ticks until nothing changes any more.
    ///
    /// # Errors
    /// [`Restless`]; the body is where it came to.
    pub fn settle(&mut self) -> Result<(), Restless> {
        let (mut quiet, mut speed, mut gone) = (0, 0.0, 0.0);
        let mut before = self.wrenches();
        let longest = self.longest_tick();
        let mut dt = SHORTEST * longest;
        for _ in 0..MOST_TICKS {
            let motion = self.tick(dt, false)?;
            let now = self.wrenches();
            quiet = if self.is_quiet(&before, &now) {
                quiet + 1
            } else {
                0
            };
            before = now;
            if quiet == QUIET_TICKS {
                return Ok(());
            }
            let way = motion.most(self.body.size());
            (speed, gone) = (way / dt, gone + way);
            if gone > MOST_SIZES * self.body.size() {
                break;
            }
            let most = (WAY_PER_SPACING * self.spacing() / way).clamp(0.1, 2.0);
            let is_brisk = speed * MILLISECOND > BRISK * self.body.size();
            let longest = if is_brisk {
                longest.max(MILLISECOND)
            } else {
                longest
            };
            dt = (dt * most).clamp(SHORTEST * longest, longest);
        }
        Err(Restless::Moving(self.time, speed))
    }

    /// The longest tick in which contact with friction, if there is any, is found, s.
    fn longest_tick(&self) -> f64 {
        let blocks = self.body.contact_blocks.iter();
        let stiffness: f64 = blocks.map(mean).sum();
        let gives = self.body.nodes.len() as f64 / (stiffness * self.young_modulus);
        let rubs = self.colliders().any(Collider::rubs);
        let times = if rubs { LONGEST_RUBBING } else { LONGEST };
        times * gives * self.prop.free.mass / self.prop.free.drag_time
    }

    /// The least distance between contact points, m.
    fn spacing(&self) -> f64 {
        let surfaces = self.colliders().filter_map(|tool| tool.surface(0));
        surfaces.fold(self.body.size(), |least, surface| {
            least.min(surface.spacing())
        })
    }

    /// Whether tools and supports are where they are to be.
    fn are_at_goals(&self) -> bool {
        let placement = &self.prop.placement;
        let supports = self.prop.supports.iter();
        let supports = supports.map(|support| (&support.collider, &support.pose));
        let tools = self.fingers.iter().map(|(tool, pose)| (tool, pose));
        tools.chain(supports).all(|(tool, goal)| {
            tool.pose().is_some_and(|pose| {
                let (way, turn) = pose.way_to(&placement.to_body(goal));
                way.length() <= AT_GOAL * self.body.size() && turn.length() <= AT_GOAL
            })
        })
    }

    /// Forces on all tools, N.
    fn wrenches(&self) -> Vec<DVec3> {
        let felt = |tool: &Collider| tool.felt().map_or(DVec3::NAN, |felt| felt.force);
        self.colliders().map(felt).collect()
    }

    /// Whether the wrenches on the body cancel and stay.
    fn is_quiet(&self, before: &[DVec3], now: &[DVec3]) -> bool {
        let weight = self.prop.gravity * self.prop.free.mass;
        let largest = largest(now).max(weight.length());
        let (force, torque) = self.wrench();
        let left = force + self.prop.placement.direction_to_body(weight);
        self.are_at_goals()
            && left.length() <= AT_REST * largest
            && torque.length() <= AT_REST * largest * self.body.size()
            && change(before, now) <= SETTLED * largest
    }
}

/// The largest of some forces, N.
fn largest(forces: &[DVec3]) -> f64 {
    (forces.iter()).fold(0.0_f64, |most, force| most.max(force.length()))
}

/// By how much a force has changed at most, N.
fn change(before: &[DVec3], now: &[DVec3]) -> f64 {
    let pairs = before.iter().zip(now);
    pairs.fold(0.0_f64, |most, (a, b)| most.max(a.distance(*b)))
}

/// Whether forces have stayed as they were, or there are none.
fn have_stayed(before: &[DVec3], now: &[DVec3]) -> bool {
    change(before, now) <= SETTLED * largest(now)
}
