//! What a tool has to do with one body: the points there that it may press, and what nodes carry of it.

use std::sync::Arc;

use glam::DVec3;

use super::marks::Marks;
use crate::body::closest::closest_point;
use crate::tool::points::ToolSurface;
use crate::tool::shape::{Pose, Tool};
use crate::tool::slot::{MOST_NODES, Slot};

/// A point counts as in the tool below this share of its reach: one that is just touched is not.
const IN_TOOL: f64 = 1e-9;
/// The place of a node that carries nothing.
const NOWHERE: u16 = u16::MAX;

/// A tool's side towards one body.
#[derive(Debug, Clone)]
pub(crate) struct Side {
    pub(super) surface: Arc<ToolSurface>,
    /// How far others moved the surface nearest to the tool in the last tick, m.
    pub(crate) carried: DVec3,
    /// In which turn each contact point was last marked.
    pub(crate) marks: Marks,
    /// Points were pressed in the last tick.
    pub(super) was_pressed: bool,
    /// Nodes that carry force, and which place each node of the body has among them.
    nodes: Vec<(u32, DVec3)>,
    place_of: Vec<u16>,
}

impl Side {
    pub(super) fn new(surface: Arc<ToolSurface>) -> Self {
        let (nodes, points) = (surface.body().nodes.len(), surface.points().len());
        Self {
            surface,
            carried: DVec3::ZERO,
            marks: Marks::new(points),
            was_pressed: false,
            nodes: Vec::with_capacity(MOST_NODES),
            place_of: vec![NOWHERE; nodes],
        }
    }

    /// The contact points.
    #[inline]
    pub(crate) fn surface(&self) -> &ToolSurface {
        &self.surface
    }

    /// Nodes that carry force, and their forces at unit modulus.
    #[inline]
    pub(crate) fn nodal_forces(&self) -> &[(u32, DVec3)] {
        &self.nodes
    }

    pub(super) fn clear(&mut self) {
        for (node, _) in self.nodes.drain(..) {
            self.place_of[node as usize] = NOWHERE;
        }
    }

    /// What the nodes of a point carry of its force.
    pub(super) fn take(&mut self, slot: &Slot) {
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

    /// Whether a tool that pressed this body is in it now, but does not press it any more, as others
    /// have moved the surface: it would come out at any side. One from which others have only moved
    /// the surface away is before the point that is nearest.
    pub(super) fn is_lost(&self, tool: &Tool, pose: &Pose, nearest: Option<&Slot>) -> bool {
        let is_before = self.carried != DVec3::ZERO
            && nearest
                .is_some_and(|slot| slot.seen.0 > 0.0 && slot.seen.1.dot(slot.at.normal) < 0.0);
        let is_pressed = !self.nodes.is_empty();
        self.was_pressed
            && !is_pressed
            && !is_before
            && !self.is_outside(tool, &pose.moved(-self.carried))
    }

    /// Whether a tool is clear of the body at rest.
    pub(super) fn is_outside(&self, tool: &Tool, pose: &Pose) -> bool {
        is_outside(&self.surface, tool, pose)
    }
}

/// Whether a tool is clear of a body at rest: no point in it, nor it in the body. One without another
/// side always is: there is one way out of it.
pub(crate) fn is_outside(surface: &ToolSurface, tool: &Tool, pose: &Pose) -> bool {
    if tool.is_endless() {
        return true;
    }
    let mut overlaps = false;
    surface.tree().visit(
        |middle, radius| tool.least_distance(pose.to_tool(middle)) <= radius,
        |point| {
            let place = surface.points()[point as usize].position;
            let distance = tool.distance(pose.to_tool(place)).0;
            overlaps = overlaps || distance < -IN_TOOL * tool.reach();
        },
    );
    let middle = pose.position + pose.rotation * tool.middle();
    !overlaps && !closest_point(surface.body(), middle, 0).1
}
