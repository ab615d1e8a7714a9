//! A rigid tool on one or more bodies: where it is, and what it felt in the last tick.

mod felt;
mod marks;
pub(crate) mod side;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DMat3, DQuat, DVec3};

use super::coefficients::{Friction, Posed};
pub use felt::{Felt, NotANumber};
use side::Side;

use super::points::ToolSurface;
use super::shape::{Pose, Tool};
use super::slot::{MOST_NEAR, Slot};
use crate::body::surface::Body;
use crate::contact::ground::MOST_BODIES;

/// Strides within which any tool is outside of any body.
const MOST_STRIDES_OUT: u32 = 2000;

/// A tool's contact points on each body that it may touch, by the body's place in the list.
pub type Surfaces = [Option<Arc<ToolSurface>>; MOST_BODIES];

/// A tool and what is kept of it from tick to tick.
#[derive(Debug, Clone)]
pub struct Collider {
    sides: [Option<Side>; MOST_BODIES],
    tool: Tool,
    friction: Friction,
    pose: Option<Pose>,
    /// The tool was outside since it was set down; until then it feels nothing.
    is_free: bool,
    felt: Result<Felt, NotANumber>,
    pressed: Vec<Slot>,
    /// Another one each time that it is lifted: what is remembered of it elsewhere is over.
    era: u64,
}

/// Eras of all tools, each its own.
static ERAS: AtomicU64 = AtomicU64::new(0);

fn next_era() -> u64 {
    ERAS.fetch_add(1, Ordering::Relaxed)
}

impl Collider {
    /// A tool on the first body alone, not yet set down.
    pub fn new(surface: Arc<ToolSurface>, tool: Tool) -> Self {
        let mut surfaces = [const { None }; MOST_BODIES];
        surfaces[0] = Some(surface);
        Self::on(surfaces, tool)
    }

    /// A tool on several bodies, not yet set down. Allocates all it ever needs.
    pub fn on(surfaces: Surfaces, tool: Tool) -> Self {
        Self {
            sides: surfaces.map(|surface| surface.map(Side::new)),
            tool,
            friction: Friction::default(),
            pose: None,
            is_free: false,
            felt: Ok(Felt::default()),
            pressed: Vec::with_capacity(MOST_NEAR),
            era: next_era(),
        }
    }

    /// The tool.
    pub fn tool(&self) -> &Tool {
        &self.tool
    }

    /// The contact points on a body.
    pub fn surface(&self, body: usize) -> Option<&Arc<ToolSurface>> {
        self.sides[body].as_ref().map(|side| &side.surface)
    }

    /// Whether it may touch a body at all.
    pub fn is_on(&self, body: &Body) -> bool {
        let mut sides = self.sides.iter().flatten();
        sides.any(|side| std::ptr::eq(&raw const **side.surface.body(), body))
    }

    #[inline]
    pub(crate) fn side(&self, body: usize) -> Option<&Side> {
        self.sides[body].as_ref()
    }

    #[inline]
    pub(crate) fn side_mut(&mut self, body: usize) -> Option<&mut Side> {
        self.sides[body].as_mut()
    }

    /// Friction from the next tick on; none unless told.
    pub fn set_friction(&mut self, friction: Friction) {
        self.friction = friction;
    }

    /// Whether it has friction.
    pub fn rubs(&self) -> bool {
        !self.friction.is_none()
    }

    /// Where the tool is: behind the pose asked for where that is farther than it may go.
    pub fn pose(&self) -> Option<&Pose> {
        self.pose.as_ref()
    }

    /// Whether the tool feels anything at all: it was outside since it was set down.
    pub fn is_free(&self) -> bool {
        self.is_free
    }

    /// What the last tick found.
    ///
    /// # Errors
    /// [`NotANumber`] if the goal was none or the forces were: the contact is let go.
    pub fn felt(&self) -> Result<&Felt, NotANumber> {
        self.felt.as_ref().map_err(|&error| error)
    }

    /// Points that are pressed, their forces at unit modulus.
    pub fn pressed(&self) -> &[Slot] {
        &self.pressed
    }

    /// Nodes of a body that carry force, and their forces at unit modulus.
    pub fn nodal_forces(&self, body: usize) -> &[(u32, DVec3)] {
        self.side(body).map_or(&[], Side::nodal_forces)
    }

    pub(crate) fn era(&self) -> u64 {
        self.era
    }

    /// The tool as friction has to know it, where it is.
    pub(crate) fn posed(&self) -> Option<Posed> {
        self.pose.map(|pose| Posed {
            pose,
            friction: self.friction,
            reach: self.tool.reach(),
        })
    }

    /// Forgets all contact; the next pose is where the tool appears.
    pub fn lift(&mut self) {
        self.pose = None;
        self.era = next_era();
        self.clear();
        for side in self.sides.iter_mut().flatten() {
            side.carried = DVec3::ZERO;
        }
    }

    /// Feels nothing.
    pub(crate) fn clear(&mut self) {
        self.felt = Ok(Felt::default());
        self.begin_taking();
        let sides = self.sides.iter_mut().flatten();
        sides.for_each(|side| side.was_pressed = false);
    }

    /// Forgets which points are pressed.
    pub(crate) fn begin_taking(&mut self) {
        self.pressed.clear();
        self.sides.iter_mut().flatten().for_each(Side::clear);
    }

    /// Lets the body go, for what was asked or found is no number.
    pub(crate) fn fail(&mut self) {
        self.lift();
        self.felt = Err(NotANumber);
    }

    /// Sets the tool down. Inside the body it feels nothing until it was outside.
    pub fn restart(&mut self, pose: &Pose) {
        self.lift();
        self.pose = Some(*pose);
        self.is_free = self.is_outside(pose);
    }

    /// Goes towards a pose by at most one stride; whether it feels the body there.
    pub(crate) fn go(&mut self, goal: &Pose) -> bool {
        if !(goal.is_finite() && self.friction.is_sound()) {
            self.fail();
            return false;
        }
        let start = match self.pose {
            Some(pose) => pose,
            None => {
                self.restart(goal);
                *goal
            }
        };
        let pose = stride(&self.tool, &start, goal);
        self.pose = Some(pose);
        self.is_free = self.is_free || self.is_outside(&pose);
        self.is_free
    }

    /// A point that is pressed, with what its nodes carry of that.
    pub(crate) fn take(&mut self, slot: Slot) {
        if let Some(side) = &mut self.sides[usize::from(slot.body)] {
            side.take(&slot);
        }
        self.pressed.push(slot);
    }

    /// What it feels; `nearest` is its nearest point on each body. A tool that lost a surface while in
    /// the body is let go, which is told.
    pub(crate) fn feel(&mut self, felt: Felt, nearest: [Option<&Slot>; MOST_BODIES]) -> bool {
        self.felt = Ok(felt);
        let mut is_lost = false;
        for (side, nearest) in self.sides.iter_mut().zip(nearest) {
            let (Some(side), Some(pose)) = (side, &self.pose) else {
                continue;
            };
            is_lost |= side.is_lost(&self.tool, pose, nearest);
            side.was_pressed = !side.nodal_forces().is_empty();
        }
        if is_lost {
            self.is_free = false;
            self.clear();
        }
        is_lost
    }

    /// The nearest pose outside of the bodies at rest, on the way on which that would push the tool out.
    pub fn way_out(&self, pose: &Pose) -> Option<Pose> {
        if self.is_outside(pose) {
            return Some(*pose);
        }
        let (mut push, mut nearest) = (DVec3::ZERO, (f64::INFINITY, DVec3::ZERO));
        let sides = self.sides.iter().flatten();
        for point in sides.flat_map(|side| side.surface.points()) {
            let distance = self.tool.distance(pose.to_tool(point.position)).0;
            push += point.normal * (-distance).max(0.0) * point.area;
            if distance < nearest.0 {
                nearest = (distance, point.normal);
            }
        }
        // Pushed alike from all sides: through the nearest one.
        let way = push.try_normalize().unwrap_or(nearest.1) * self.tool.stride();
        (1..MOST_STRIDES_OUT)
            .map(|strides| pose.moved(way * f64::from(strides)))
            .find(|pose| self.is_outside(pose))
    }

    /// Whether the tool is clear of all bodies at rest.
    fn is_outside(&self, pose: &Pose) -> bool {
        let mut sides = self.sides.iter().flatten();
        sides.all(|side| side.is_outside(&self.tool, pose))
    }
}

/// The pose one stride on the way to a goal; a turn counts as the way of the farthest point.
fn stride(tool: &Tool, start: &Pose, goal: &Pose) -> Pose {
    let (way, turn) = start.way_to(goal);
    let length = way.length() + turn.length() * tool.reach();
    if length <= tool.stride() {
        return *goal;
    }
    let share = tool.stride() / length;
    let turned = DMat3::from_quat(DQuat::from_scaled_axis(turn * share)) * start.rotation;
    Pose {
        position: start.position + way * share,
        rotation: turned,
    }
}
