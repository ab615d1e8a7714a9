//! A body of the pile: where it is, what presses it, how it gives way.

use std::sync::Arc;

use glam::DVec3;

use super::between::Between;
use crate::body::surface::Body;
use crate::contact::cones::mean;
use crate::contact::ground::{Ground, MOST_TOOLS};
use crate::contact::mobility::Mobility;
use crate::creep::step::Step;
use crate::rest::free_body::FreeBody;
use crate::rest::placement::Placement;
use crate::tool::patch::Patch;
use crate::tool::points::ToolSurface;
use crate::tool::slot::Slot;

/// No slot: the point is not looked at.
const NONE: u32 = u32::MAX;
/// All slots of a patch are of this one number of a tool and body: what presses them is told by contacts.
const ALL: [u8; 2] = [0, 0];

/// A body of the pile.
#[derive(Debug, Clone)]
pub struct Member {
    /// Where it can be touched.
    pub surface: Arc<ToolSurface>,
    /// Pa.
    pub young_modulus: f64,
    /// Its mass and drag; none for one that is held.
    pub free: Option<FreeBody>,
    /// Where its frame is in the world.
    pub placement: Placement,
    /// Middle of its outline, how far that reaches, and its corners, m.
    pub(super) around: (DVec3, f64),
    outline: [DVec3; 2],
    patch: Patch,
    /// The slot of each contact point, or none.
    slot_of: Vec<u32>,
    between: Between,
}

impl Member {
    /// A body that nothing presses yet.
    pub fn new(
        surface: Arc<ToolSurface>,
        young_modulus: f64,
        free: Option<FreeBody>,
        placement: Placement,
    ) -> Self {
        let nodes = &surface.body().nodes;
        let low = nodes.iter().fold(DVec3::INFINITY, |low, &at| low.min(at));
        let high = (nodes.iter()).fold(DVec3::NEG_INFINITY, |high, &at| high.max(at));
        let middle = (low + high) * 0.5;
        let reach = (nodes.iter()).fold(0.0_f64, |most, at| most.max(at.distance(middle)));
        Self {
            slot_of: vec![NONE; surface.points().len()],
            surface,
            young_modulus,
            free,
            placement,
            around: (middle, reach),
            outline: [low, high],
            patch: Patch::new(),
            between: Between::default(),
        }
    }

    /// The body itself.
    #[inline]
    pub fn body(&self) -> &Body {
        self.surface.body()
    }

    /// Whether a place of its frame is within `margin` m of its outline.
    #[inline]
    pub(super) fn is_around(&self, place: DVec3, margin: f64) -> bool {
        let [low, high] = self.outline;
        place.clamp(low, high).distance(place) <= margin
    }

    /// Slots of points that are looked at.
    #[inline]
    pub(super) fn slots(&self) -> &[Slot] {
        self.patch.slots()
    }

    /// How far a contact point is moved in the body's frame, m; one that is not looked at, not at all.
    #[inline]
    pub(super) fn moved(&self, point: u32) -> DVec3 {
        let slot = self.slots().get(self.slot_of[point as usize] as usize);
        slot.map_or(DVec3::ZERO, |slot| slot.moved)
    }

    /// The slot of a point that is looked at.
    #[inline]
    pub(super) fn slot(&self, point: u32) -> usize {
        self.slot_of[point as usize] as usize
    }

    /// Where a contact point is in the world, m.
    #[inline]
    pub fn place(&self, point: u32) -> DVec3 {
        let at = self.surface.points()[point as usize].position;
        self.placement.to_world(at + self.moved(point))
    }

    /// Looks at these points, in their order, and no others.
    pub(super) fn look_at(&mut self, points: &[u32]) {
        for slot in (0..self.slots().len()).rev() {
            let point = self.slots()[slot].point;
            if points.binary_search(&point).is_err() {
                self.between.leave(slot, self.slots().len() - 1);
                self.patch.leave(slot);
                self.slot_of[point as usize] = NONE;
                if let Some(moved) = self.patch.slots().get(slot) {
                    self.slot_of[moved.point as usize] = slot as u32;
                }
            }
        }
        let ground = Ground {
            body: &Arc::clone(self.surface.body()),
            number: 0,
            young_modulus: self.young_modulus,
            creep: Step::default(),
            mobility: None,
        };
        for &point in points {
            if self.slot_of[point as usize] == NONE {
                let new = self.slots().len();
                self.patch
                    .enter(&ground, &self.surface, ALL, point, &[true; MOST_TOOLS]);
                self.slot_of[point as usize] = new as u32;
                let (patch, compliance) = (&self.patch, 1.0 / self.young_modulus);
                let moves = |slot| patch.compliance(slot, new) * compliance;
                self.between.enter(new, moves);
            }
        }
    }

    /// How the slots give way to forces on each other.
    #[inline]
    pub(super) fn between(&self) -> &Between {
        &self.between
    }

    /// Displaces the slots by these forces on them, N in the body's frame.
    pub(super) fn load(&mut self, forces: &[DVec3]) {
        for (slot, force) in self.patch.slots_mut().iter_mut().zip(forces) {
            slot.force = *force * (1.0 / self.young_modulus);
        }
        self.patch.displace();
    }

    /// The elastic energy in it, J.
    pub fn elastic(&self) -> f64 {
        let slots = self.slots().iter();
        let held = slots.map(|slot| 0.5 * slot.force.dot(slot.moved));
        held.sum::<f64>() * self.young_modulus
    }

    /// Forces on its contact points, N in its frame.
    pub fn loads(&self) -> impl Iterator<Item = (u32, DVec3)> {
        let slots = self.slots().iter();
        slots.map(|slot| (slot.point, slot.force * self.young_modulus))
    }

    /// How wrenches in N move it in `dt` s; not at all where it is held.
    pub(super) fn mobility(&self, gravity: DVec3, dt: f64) -> Option<Mobility> {
        let own = self.placement.direction_to_body(gravity);
        self.free.map(|free| free.mobility(own, 1.0, dt))
    }

    /// How far a place of it gives way to a force, about, m/N.
    pub(super) fn gives(&self) -> f64 {
        let stiffness: f64 = self.body().contact_blocks.iter().map(mean).sum();
        self.body().nodes.len() as f64 / (stiffness * self.young_modulus)
    }
}
