//! A rigid tool on a body: where it is, and what it felt in the last tick.

mod marks;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DMat3, DQuat, DVec3};

use super::coefficients::{Friction, Posed};
use marks::Marks;

use super::effort::Effort;
use super::points::ToolSurface;
use super::shape::{Pose, Tool};
use super::slot::Slot;
use crate::body::closest::closest_point;

/// Contact points that a tool can have near it at once.
pub const MOST_NEAR: usize = 160;
/// Nodes that can carry its force.
pub const MOST_NODES: usize = 3 * MOST_NEAR;
/// A point counts as in the tool below this share of its reach: one that is just touched is not.
const IN_TOOL: f64 = 1e-9;
/// Strides within which any tool is outside of any body.
const MOST_STRIDES_OUT: u32 = 2000;
/// The place of a node that carries nothing.
const NOWHERE: u16 = u16::MAX;

/// What the tool feels, and how it was found.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Felt {
    /// Force on the tool, N.
    pub force: DVec3,
    /// Torque on the tool about its reference point, N m.
    pub torque: DVec3,
    /// How the force resists a small move of the tool while other tools stay, N/m.
    pub stiffness: DMat3,
    /// Points that are pressed.
    pub pressed: usize,
    /// Linearisations it took.
    pub linearisations: usize,
    /// All points near were looked at, and displacements stopped changing within the bound.
    pub exact: bool,
    /// What the tick took, of all tools.
    pub effort: Effort,
}

/// What came out is no number: no force may be made of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotANumber;

/// A tool on a body and what is kept of it from tick to tick.
#[derive(Debug, Clone)]
pub struct Collider {
    surface: Arc<ToolSurface>,
    tool: Tool,
    friction: Friction,
    pose: Option<Pose>,
    /// The tool was outside since it was set down; until then it feels nothing.
    is_free: bool,
    /// How far others moved the surface nearest to the tool in the last tick, m.
    pub(crate) carried: DVec3,
    felt: Result<Felt, NotANumber>,
    pressed: Vec<Slot>,
    /// Nodes that carry force, and which place each node of the body has among them.
    nodes: Vec<(u32, DVec3)>,
    place_of: Vec<u16>,
    /// In which turn each contact point was last marked.
    pub(crate) marks: Marks,
    /// Another one each time that it is lifted: what is remembered of it elsewhere is over.
    era: u64,
}

/// Eras of all tools, each its own.
static ERAS: AtomicU64 = AtomicU64::new(0);

fn next_era() -> u64 {
    ERAS.fetch_add(1, Ordering::Relaxed)
}

impl Collider {
    /// A tool that was not yet set down. Allocates all it ever needs.
    pub fn new(surface: Arc<ToolSurface>, tool: Tool) -> Self {
        let (nodes, points) = (surface.body().nodes.len(), surface.points().len());
        Self {
            surface,
            tool,
            friction: Friction::default(),
            pose: None,
            is_free: false,
            carried: DVec3::ZERO,
            felt: Ok(Felt::default()),
            pressed: Vec::with_capacity(MOST_NEAR),
            nodes: Vec::with_capacity(MOST_NODES),
            place_of: vec![NOWHERE; nodes],
            marks: Marks::new(points),
            era: next_era(),
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

    /// Nodes of the body that carry force, and their forces at unit modulus.
    pub fn nodal_forces(&self) -> &[(u32, DVec3)] {
        &self.nodes
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
        (self.pose, self.carried) = (None, DVec3::ZERO);
        self.era = next_era();
        self.clear();
    }

    /// Feels nothing.
    pub(crate) fn clear(&mut self) {
        self.felt = Ok(Felt::default());
        self.begin_taking();
    }

    /// Forgets which points are pressed.
    pub(crate) fn begin_taking(&mut self) {
        self.pressed.clear();
        for (node, _) in self.nodes.drain(..) {
            self.place_of[node as usize] = NOWHERE;
        }
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
    pub(crate) fn take(&mut self, slot: &Slot) {
        self.pressed.push(*slot);
        for (node, weight) in slot.at.nodes.into_iter().zip(slot.at.alpha) {
            if weight == 0.0 {
                continue;
            }
            let place = &mut self.place_of[node as usize];
            if *place == NOWHERE {
                *place = self.nodes.len() as u16;
                self.nodes.push((node, slot.force * weight));
            } else {
                self.nodes[usize::from(*place)].1 += slot.force * weight;
            }
        }
    }

    /// What it feels. A tool that lost the surface, as others have moved it, while in the body would
    /// come out at any side: it is let go, which is told. One from which others have only moved the
    /// surface away is before the point that is nearest.
    pub(crate) fn feel(&mut self, felt: Felt, nearest: Option<&Slot>) -> bool {
        let was_pressed = self.felt.is_ok_and(|felt| felt.pressed > 0);
        self.felt = Ok(felt);
        let back = self.pose.map(|pose| pose.moved(-self.carried));
        let is_before = self.carried != DVec3::ZERO
            && nearest
                .is_some_and(|slot| slot.seen.0 > 0.0 && slot.seen.1.dot(slot.at.normal) < 0.0);
        let is_lost = was_pressed
            && felt.pressed == 0
            && !is_before
            && back.is_some_and(|back| !self.is_outside(&back));
        if is_lost {
            self.is_free = false;
            self.clear();
        }
        is_lost
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
