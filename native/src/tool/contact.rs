//! A tool that follows a pose from tick to tick, and the forces of the body on it.
//!
//! Each contact point's force pushes along the tool's normal where the point has gone to:
//! F_i = f_i n_i, n_i = grad phi(x_i + u_i), f_i >= 0, phi >= 0, one of both zero. The distance is
//! linearised about the displacements of the last tick, a few times at most; what that leaves to be
//! found the next ticks find. Readable reference: `core/contact/tool/tool_contact.py` and `core/contact/tool/tool_law.py`.

mod choose;
mod feel;
mod offset;
mod settle;

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::complementarity::Complementarity;
use super::effort::Effort;
use super::friction::{Friction, Rubbing, take_anchors};
use super::patch::{Patch, Slot};
use super::points::ToolSurface;
use super::shape::{Pose, Tool};
use crate::algebra::MOST_POINTS;
use crate::body::closest::closest_point;

/// A point counts as in the tool below this share of its reach: one that is just touched is not.
const IN_TOOL: f64 = 1e-9;
/// Points that may enter in one tick.
const MOST_ENTERING: usize = 24;
/// Strides within which any tool is outside of any body.
const MOST_STRIDES_OUT: u32 = 2000;
/// Nodes that can carry force.
pub const MOST_NODES: usize = 3 * MOST_POINTS;

/// What the tool feels, and how it was found.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Felt {
    /// Force on the tool, N.
    pub force: DVec3,
    /// Torque on the tool about its reference point, N m.
    pub torque: DVec3,
    /// How the force resists a small move of the tool, N/m.
    pub stiffness: DMat3,
    /// Points that are pressed.
    pub pressed: usize,
    /// Linearisations it took.
    pub linearisations: usize,
    /// All points near were looked at, and displacements stopped changing within the bound.
    pub exact: bool,
    /// What it took.
    pub effort: Effort,
}

/// What came out is no number: no force may be made of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotANumber;

/// A tool on a body and all that is kept from tick to tick.
#[derive(Debug, Clone)]
pub struct ToolContact {
    surface: Arc<ToolSurface>,
    tool: Tool,
    pose: Option<Pose>,
    /// The tool was outside since it was set down; until then it feels nothing.
    is_free: bool,
    patch: Patch,
    problem: Complementarity,
    friction: Friction,
    rubbing: Rubbing,
    /// Which slot each unknown belongs to.
    chosen: Vec<usize>,
    /// What points enter, nearest first.
    entering: Vec<(f64, u32)>,
    felt: Felt,
    effort: Effort,
    /// Nodes that carry force, and which place each node of the body has among them.
    nodes: Vec<(u32, DVec3)>,
    place_of: Vec<u16>,
    /// Displacements of nodes by other fingers, in the tick that is told.
    moved_nodes: Vec<(u64, DVec3)>,
    /// How far they moved the surface nearest to the tool in the last tick, m.
    carried: DVec3,
    tick: u64,
}

/// The place of a node that carries nothing.
const NOWHERE: u16 = u16::MAX;

impl ToolContact {
    /// A tool that was not yet set down. Allocates all it ever needs.
    pub fn new(surface: Arc<ToolSurface>, tool: Tool) -> Self {
        let nodes = surface.body().nodes.len();
        Self {
            patch: Patch::new(surface.points().len(), nodes),
            surface,
            tool,
            pose: None,
            is_free: false,
            problem: Complementarity::default(),
            friction: Friction::default(),
            rubbing: Rubbing::new(),
            chosen: Vec::with_capacity(MOST_POINTS),
            entering: Vec::with_capacity(MOST_ENTERING + 1),
            felt: Felt::default(),
            effort: Effort::default(),
            nodes: Vec::with_capacity(MOST_NODES),
            place_of: vec![NOWHERE; nodes],
            moved_nodes: vec![(0, DVec3::NAN); nodes],
            carried: DVec3::ZERO,
            tick: 0,
        }
    }

    /// The tool.
    pub fn tool(&self) -> &Tool {
        &self.tool
    }

    /// The contact points.
    pub fn surface(&self) -> &Arc<ToolSurface> {
        &self.surface
    }

    /// Friction from the next tick on; none unless told.
    pub fn set_friction(&mut self, friction: Friction) {
        self.friction = friction;
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
    pub fn felt(&self) -> &Felt {
        &self.felt
    }

    /// Points near the tool, their forces at unit modulus.
    pub fn slots(&self) -> &[Slot] {
        self.patch.slots()
    }

    /// Nodes of the body that carry force, and their forces at unit modulus.
    pub fn nodal_forces(&self) -> &[(u32, DVec3)] {
        &self.nodes
    }

    /// Forgets all contact; the next pose is where the tool appears.
    pub fn lift(&mut self) {
        (self.pose, self.carried) = (None, DVec3::ZERO);
        self.let_go();
    }

    fn let_go(&mut self) {
        self.patch.clear();
        self.felt = Felt::default();
        self.clear_nodes();
    }

    /// Sets the tool down. Inside the body it feels nothing until it was outside.
    pub fn restart(&mut self, pose: &Pose) {
        self.lift();
        self.pose = Some(*pose);
        self.is_free = self.is_outside(pose);
    }

    /// One tick: the tool goes towards a pose by at most one stride, and feels the body there.
    ///
    /// `outside` are forces of other fingers on nodes, N.
    ///
    /// # Errors
    /// [`NotANumber`] anywhere, or friction that is none: the contact is let go.
    pub fn follow(
        &mut self,
        goal: &Pose,
        young_modulus: f64,
        outside: &[(u32, DVec3)],
    ) -> Result<&Felt, NotANumber> {
        let is_stiffness = young_modulus > 0.0 && young_modulus.is_finite();
        if !(goal.is_finite() && is_stiffness && self.friction.is_sound()) {
            self.lift();
            return Err(NotANumber);
        }
        let Some(start) = self.pose else {
            self.restart(goal);
            return self.follow(goal, young_modulus, outside);
        };
        let pose = stride(&self.tool, &start, goal);
        self.pose = Some(pose);
        self.tick += 1;
        self.effort = Effort::default();
        if !self.is_free {
            self.is_free = self.is_outside(&pose);
            if !self.is_free {
                return Ok(&self.felt);
            }
        }
        let was_pressed = self.felt.pressed > 0;
        self.offset(outside, young_modulus);
        let all_in = self.choose(&pose, outside, young_modulus);
        let (linearisations, exact) = self.settle(&pose);
        let stuck = take_anchors(&mut self.patch, &self.surface, &pose, &self.friction);
        self.feel(&pose, young_modulus, stuck);
        self.felt.linearisations = linearisations;
        self.felt.exact = exact && all_in;
        self.felt.effort = self.effort;
        let are_numbers = self.felt.force.is_finite()
            && self.felt.torque.is_finite()
            && self.patch.slots().iter().all(|slot| slot.moved.is_finite());
        if !are_numbers {
            self.lift();
            return Err(NotANumber);
        }
        // A tool that lost the surface, as others have moved it, while in the body would come out at
        // any side.
        let back = pose.moved(-self.carried);
        if was_pressed && self.felt.pressed == 0 && !self.is_outside(&back) {
            self.is_free = false;
            self.let_go();
        }
        Ok(&self.felt)
    }

    /// The nearest pose outside of the body at rest, on the way on which that would push the tool out.
    pub fn way_out(&self, pose: &Pose) -> Option<Pose> {
        if self.is_outside(pose) {
            return Some(*pose);
        }
        let (mut push, mut nearest) = (DVec3::ZERO, (f64::INFINITY, DVec3::ZERO));
        for point in self.surface.points() {
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

    /// Whether the tool is clear of the body at rest: no point in it, nor it in the body.
    fn is_outside(&self, pose: &Pose) -> bool {
        let mut overlaps = false;
        let tool = &self.tool;
        self.surface.tree().visit(
            |middle, radius| tool.least_distance(pose.to_tool(middle)) <= radius,
            |point| {
                let place = self.surface.points()[point as usize].position;
                let distance = tool.distance(pose.to_tool(place)).0;
                overlaps = overlaps || distance < -IN_TOOL * tool.reach();
            },
        );
        let middle = pose.position + pose.rotation * tool.middle();
        !overlaps && !closest_point(self.surface.body(), middle, 0).1
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
