//! A tool that follows a pose from tick to tick, and the forces of the body on it.
//!
//! Each contact point's force pushes along the tool's normal where the point has gone to:
//! F_i = f_i n_i, n_i = grad phi(x_i + u_i), f_i >= 0, phi >= 0, one of both zero. The distance is
//! linearised about the displacements of the last tick, a few times at most; what that leaves to be
//! found the next ticks find. Readable reference: `core/tool_contact.py` and `core/tool_law.py`.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::MOST_POINTS;
use super::complementarity::Complementarity;
use super::friction::{Friction, Rubbing, across, take_anchors};
use super::patch::{Patch, Slot};
use super::points::ToolSurface;
use super::shape::{Pose, Tool};
use super::tilt::Hold;
use crate::closest::closest_point;
use crate::coupling::largest_eigenvalue;

/// Linearisations in one tick.
const MOST_LINEARISATIONS: usize = 4;
/// Multiplications that a tick takes, about, before it leaves the rest to the next.
const MOST_WORK: usize = 350_000;
/// The same with friction.
const MOST_WORK_RUBBING: usize = 450_000;
/// Points farther from the tool than this share of the margin are only watched.
const WATCHED: f64 = 0.3;
/// Displacements that change by less than this share of the tool's reach have been found.
const CONVERGED: f64 = 1e-5;
/// A point counts as in the tool below this share of its reach: one that is just touched is not.
const IN_TOOL: f64 = 1e-9;
/// Points within so many spacings of the tool are looked at.
const MARGIN: f64 = 1.0;
/// Points beyond this many margins, at rest and now, are forgotten.
const FORGOTTEN: f64 = 1.5;
/// Points that may enter in one tick.
const MOST_ENTERING: usize = 24;
/// Once so many blocks of the compliance had to be fetched in a tick, further points wait.
const MOST_FETCHED: usize = 256;
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
}

/// What came out is no number: no force may be made of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotANumber;

/// A tool on a body and all that is kept from tick to tick.
#[derive(Debug)]
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
    /// Nodes that carry force, and which place each node of the body has among them.
    nodes: Vec<(u32, DVec3)>,
    place_of: Vec<u16>,
    /// Displacements of nodes by other fingers, in the tick that is told.
    moved_nodes: Vec<(u64, DVec3)>,
    tick: u64,
}

/// The place of a node that carries nothing.
const NOWHERE: u16 = u16::MAX;

impl ToolContact {
    /// A tool that was not yet set down. Allocates all it ever needs.
    pub fn new(surface: Arc<ToolSurface>, tool: Tool) -> Self {
        let nodes = surface.body().nodes.len();
        Self {
            patch: Patch::new(surface.points().len()),
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
            nodes: Vec::with_capacity(MOST_NODES),
            place_of: vec![NOWHERE; nodes],
            moved_nodes: vec![(0, DVec3::NAN); nodes],
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
        self.pose = None;
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
        if !self.is_free {
            self.is_free = self.is_outside(&pose);
            if !self.is_free {
                return Ok(&self.felt);
            }
        }
        let was_pressed = self.felt.pressed > 0;
        let all_in = self.choose(&pose);
        self.offset(outside, young_modulus);
        let (linearisations, exact) = self.settle(&pose);
        let stuck = take_anchors(&mut self.patch, &self.surface, &pose, &self.friction);
        self.feel(&pose, young_modulus, stuck);
        self.felt.linearisations = linearisations;
        self.felt.exact = exact && all_in;
        let are_numbers = self.felt.force.is_finite()
            && self.felt.torque.is_finite()
            && self.patch.slots().iter().all(|slot| slot.moved.is_finite());
        if !are_numbers {
            self.lift();
            return Err(NotANumber);
        }
        // A tool that lost the surface while in the body would come out at any side.
        if was_pressed && self.felt.pressed == 0 && !self.is_outside(&pose) {
            self.is_free = false;
            self.let_go();
        }
        Ok(&self.felt)
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

    /// Lets points go that are far, and those near come in, nearest first; whether all of them are.
    fn choose(&mut self, pose: &Pose) -> bool {
        let margin = MARGIN * self.surface.spacing();
        let tool = &self.tool;
        for number in (0..self.patch.slots().len()).rev() {
            let rest = self.patch.point(&self.surface, number).position;
            let slot = &mut self.patch.slots_mut()[number];
            slot.at_rest = tool.distance(pose.to_tool(rest)).0;
            slot.distance = tool.distance(pose.to_tool(rest + slot.moved)).0;
            let is_far = slot.at_rest.min(slot.distance) > FORGOTTEN * margin;
            if is_far && slot.force == DVec3::ZERO && !self.is_beside_pressed(number, pose) {
                self.patch.leave(number);
            }
        }
        self.entering.clear();
        let (points, patch) = (self.surface.points(), &self.patch);
        let entering = &mut self.entering;
        let mut offer = |point: u32, moved: DVec3| {
            if patch.has(point) {
                return;
            }
            let place = points[point as usize].position + moved;
            let (distance, _) = tool.distance(pose.to_tool(place));
            if distance <= margin {
                insert(entering, distance, point);
            }
        };
        self.surface.tree().visit(
            |middle, radius| tool.least_distance(pose.to_tool(middle)) <= margin + radius,
            |point| offer(point, DVec3::ZERO),
        );
        // Deep in the body the tool is past where the points were at rest: they come in from the side.
        for slot in patch.slots() {
            if slot.force != DVec3::ZERO {
                for &other in self.surface.neighbours(slot.point) {
                    offer(other, slot.moved);
                }
            }
        }
        let first = self.patch.fetched();
        for place in 0..self.entering.len() {
            let (distance, point) = self.entering[place];
            if self.patch.fetched() - first > MOST_FETCHED {
                return false;
            }
            if self.patch.is_full() && !self.make_room(distance) {
                return false;
            }
            self.patch.enter(&self.surface, point);
        }
        self.entering.len() < MOST_ENTERING
    }

    /// Whether a point would be near the tool if it went where a pressed neighbour went.
    fn is_beside_pressed(&self, number: usize, pose: &Pose) -> bool {
        let slot = &self.patch.slots()[number];
        let rest = self.patch.point(&self.surface, number).position;
        let limit = FORGOTTEN * MARGIN * self.surface.spacing();
        let mut others = self.surface.neighbours(slot.point).iter();
        others.any(|&other| {
            self.patch.slot(other).is_some_and(|other| {
                let place = pose.to_tool(rest + other.moved);
                other.force != DVec3::ZERO && self.tool.distance(place).0 <= limit
            })
        })
    }

    /// Drops the farthest point without force, if it is farther than told.
    fn make_room(&mut self, distance: f64) -> bool {
        let mut farthest: Option<(f64, usize)> = None;
        for (number, slot) in self.patch.slots().iter().enumerate() {
            let near = slot.at_rest.min(slot.distance);
            if slot.force == DVec3::ZERO && near > farthest.map_or(distance, |(d, _)| d) {
                farthest = Some((near, number));
            }
        }
        farthest
            .map(|(_, number)| self.patch.leave(number))
            .is_some()
    }

    /// Displacements of the points by other fingers.
    fn offset(&mut self, outside: &[(u32, DVec3)], young_modulus: f64) {
        for number in 0..self.patch.slots().len() {
            let mut offset = DVec3::ZERO;
            if !outside.is_empty() {
                let point = *self.patch.point(&self.surface, number);
                for (&node, &weight) in point.nodes.iter().zip(&point.alpha) {
                    if weight != 0.0 {
                        offset += self.moved_node(node, outside) * (weight / young_modulus);
                    }
                }
            }
            self.patch.slots_mut()[number].offset = offset;
        }
    }

    /// Displacement of a node at unit modulus, found once a tick.
    fn moved_node(&mut self, node: u32, outside: &[(u32, DVec3)]) -> DVec3 {
        let known = self.moved_nodes[node as usize];
        if known.0 == self.tick {
            return known.1;
        }
        let (blocks, body) = (self.patch.blocks_mut(), self.surface.body());
        let moved = (outside.iter())
            .map(|&(other, force)| blocks.get(body, node, other) * force)
            .sum();
        self.moved_nodes[node as usize] = (self.tick, moved);
        moved
    }

    /// Finds the equilibrium of the points with the tool, from the last tick's forces on.
    fn settle(&mut self, pose: &Pose) -> (usize, bool) {
        let limit = CONVERGED * self.tool.reach();
        let rubs = !self.friction.is_none();
        let most_work = if rubs { MOST_WORK_RUBBING } else { MOST_WORK };
        let mut work = 0;
        self.patch.displace();
        for made in 1..=MOST_LINEARISATIONS {
            self.linearise(pose);
            self.problem.solve(MOST_WORK.min(most_work - work));
            for slot in self.patch.slots_mut() {
                (slot.force, slot.push) = (DVec3::ZERO, 0.0);
            }
            for (place, &number) in self.chosen.iter().enumerate() {
                let slot = &mut self.patch.slots_mut()[number];
                slot.force = slot.normal * self.problem.forces[place];
                slot.push = slot.force.length();
            }
            let change = if rubs {
                let (friction, reach) = (&self.friction, self.tool.reach());
                self.rubbing
                    .rub(&mut self.patch, &self.surface, pose, friction, reach)
            } else {
                self.patch.displace()
            };
            if change <= limit {
                return (made, true);
            }
            // Another one takes as much again.
            let (chosen, near) = (self.chosen.len(), self.patch.slots().len());
            let own = self.problem.work() + 6 * chosen * chosen + 9 * chosen * near;
            let own = own + if rubs { self.rubbing.work() } else { 0 };
            work += own;
            if work + own > most_work {
                return (made, false);
            }
        }
        (MOST_LINEARISATIONS, false)
    }

    /// The complementarity problem of the distances linearised about the displacements.
    fn linearise(&mut self, pose: &Pose) {
        self.chosen.clear();
        let watched = WATCHED * MARGIN * self.surface.spacing();
        let points = self.surface.points();
        let pushes = self.patch.slots().iter().map(|slot| {
            let facing = points[slot.point as usize].normal;
            (slot.push * slot.normal, facing)
        });
        let hold = Hold::of(pushes).map(|hold| hold.seen_from(&pose.rotation));
        for (number, slot) in self.patch.slots_mut().iter_mut().enumerate() {
            let rest = points[slot.point as usize].position;
            let place = pose.to_tool(rest + slot.moved);
            let free = self.tool.distance(place);
            let (distance, normal) = hold.map_or(free, |hold| hold.hold(free, place, &self.tool));
            let normal = pose.rotation * normal;
            if distance < watched || slot.force != DVec3::ZERO {
                let place = self.chosen.len();
                self.problem.forces[place] = slot.push;
                self.problem.gaps[place] = distance - normal.dot(slot.moved - slot.offset);
                self.chosen.push(number);
            }
            (slot.distance, slot.normal) = (distance, normal);
        }
        if !self.friction.is_none() {
            // What the forces aside move counts as given, like the other fingers'.
            for slot in self.patch.slots_mut() {
                slot.aside = across(slot.aside, slot.normal);
            }
            let [x, y, z] = self.patch.moved_aside();
            let moved = |i: usize| DVec3::new(x[i], y[i], z[i]);
            let given: [DVec3; MOST_POINTS] = std::array::from_fn(moved);
            for (place, &number) in self.chosen.iter().enumerate() {
                let normal = self.patch.slots()[number].normal;
                self.problem.gaps[place] += normal.dot(given[number]);
            }
        }
        self.problem.begin(self.chosen.len());
        for (j, &loaded) in self.chosen.iter().enumerate() {
            let normal = self.patch.slots()[loaded].normal;
            let [x, y, z] = *self.patch.moved_by(loaded, normal);
            for (i, &seen) in self.chosen.iter().enumerate().skip(j) {
                let moved = DVec3::new(x[seen], y[seen], z[seen]);
                let along = self.patch.slots()[seen].normal.dot(moved);
                self.problem.set(i, j, along);
            }
        }
    }

    /// Sums the forces up.
    fn feel(&mut self, pose: &Pose, young_modulus: f64, stuck: f64) {
        let mut felt = Felt::default();
        self.clear_nodes();
        for number in 0..self.patch.slots().len() {
            let slot = self.patch.slots()[number];
            if slot.force == DVec3::ZERO {
                continue;
            }
            let point = self.patch.point(&self.surface, number);
            let arm = point.position + slot.moved - pose.position;
            felt.force -= slot.force * young_modulus;
            felt.torque -= arm.cross(slot.force * young_modulus);
            felt.pressed += 1;
            let (nodes, alpha) = (point.nodes, point.alpha);
            for (&node, &weight) in nodes.iter().zip(&alpha) {
                if weight != 0.0 {
                    self.load(node, slot.force * weight);
                }
            }
        }
        felt.stiffness = with_stuck(self.stiffness(), stuck) * young_modulus;
        self.felt = felt;
    }

    fn load(&mut self, node: u32, force: DVec3) {
        let place = &mut self.place_of[node as usize];
        if *place == NOWHERE {
            *place = self.nodes.len() as u16;
            self.nodes.push((node, force));
        } else {
            self.nodes[*place as usize].1 += force;
        }
    }

    fn clear_nodes(&mut self) {
        for (node, _) in self.nodes.drain(..) {
            self.place_of[node as usize] = NOWHERE;
        }
    }

    /// sum_ij n_i [(N' C N)^-1]_ij n_j' over the pressed points, at unit modulus.
    fn stiffness(&mut self) -> DMat3 {
        let Some((face, factor)) = self.problem.factor_on_face() else {
            return DMat3::ZERO;
        };
        let mut columns = [[0.0; MOST_POINTS]; 3];
        for (place, &i) in face.iter().enumerate() {
            let normal = self.patch.slots()[self.chosen[i]].normal;
            for (column, n) in columns.iter_mut().zip(normal.to_array()) {
                column[place] = n;
            }
        }
        for column in &mut columns {
            factor.solve_lower(&mut column[..face.len()]);
        }
        let product = |a: usize, b: usize| {
            super::cholesky::dot(&columns[a][..face.len()], &columns[b][..face.len()])
        };
        let [xy, yz, zx] = [product(0, 1), product(1, 2), product(2, 0)];
        DMat3::from_cols(
            DVec3::new(product(0, 0), xy, zx),
            DVec3::new(xy, product(1, 1), yz),
            DVec3::new(zx, yz, product(2, 2)),
        )
    }
}

/// The stiffness of a tool without friction, with what points that stick add aside: where all stick
/// the tool counts as held on all sides as it is where that is stiffest. More than it is: a patch
/// that sticks is at most nine tenths as stiff aside as into the body (R. D. Mindlin, 1949).
fn with_stuck(stiffness: DMat3, stuck: f64) -> DMat3 {
    if stuck == 0.0 {
        return stiffness;
    }
    let all_round = DMat3::from_diagonal(DVec3::splat(largest_eigenvalue(&stiffness)));
    stiffness + (all_round - stiffness) * stuck
}

/// Keeps the nearest points, nearest first.
fn insert(entering: &mut Vec<(f64, u32)>, distance: f64, point: u32) {
    if entering.iter().any(|&(_, other)| other == point) {
        return;
    }
    let place = entering.partition_point(|&(d, _)| d <= distance);
    if place < MOST_ENTERING {
        entering.insert(place, (distance, point));
        entering.truncate(MOST_ENTERING);
    }
}

/// The pose one stride on the way to a goal; a turn counts as the way of the farthest point.
fn stride(tool: &Tool, start: &Pose, goal: &Pose) -> Pose {
    let way = goal.position - start.position;
    let turn = DQuat::from_mat3(&(goal.rotation * start.rotation.transpose())).normalize();
    let turn = turn.to_scaled_axis();
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
