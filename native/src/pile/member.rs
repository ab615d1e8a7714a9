//! A body of the pile: where it is, what presses it, how it gives way.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};

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
    slot_of: HashMap<u32, usize>,
    /// How each slot gives way to a force on each, row by row, m/N.
    between: Vec<DMat3>,
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
            surface,
            young_modulus,
            free,
            placement,
            around: (middle, reach),
            outline: [low, high],
            patch: Patch::new(),
            slot_of: HashMap::new(),
            between: Vec::new(),
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
        let slot = self.slot_of.get(&point);
        slot.map_or(DVec3::ZERO, |&slot| self.slots()[slot].moved)
    }

    /// The slot of a point that is looked at.
    #[inline]
    pub(super) fn slot(&self, point: u32) -> usize {
        self.slot_of[&point]
    }

    /// Where a contact point is in the world, m.
    #[inline]
    pub fn place(&self, point: u32) -> DVec3 {
        let at = self.surface.points()[point as usize].position;
        self.placement.to_world(at + self.moved(point))
    }

    /// Looks at these points, and no others.
    pub(super) fn look_at(&mut self, points: &[u32]) {
        let had = self.patch.slots().len();
        self.patch.let_go(|slot| !points.contains(&slot.point));
        let mut is_new = self.patch.slots().len() != had;
        let body = Arc::clone(self.surface.body());
        let ground = Ground {
            body: &body,
            number: 0,
            young_modulus: self.young_modulus,
            creep: Step::default(),
            mobility: None,
        };
        for &point in points {
            if self.patch.slot(ALL, point).is_none() {
                self.patch
                    .enter(&ground, &self.surface, ALL, point, &[true; MOST_TOOLS]);
                is_new = true;
            }
        }
        if is_new {
            let slots = self.patch.slots().iter().enumerate();
            self.slot_of = slots.map(|(slot, at)| (at.point, slot)).collect();
            self.find_between();
        }
    }

    fn find_between(&mut self) {
        let count = self.patch.slots().len();
        self.between.resize(count * count, DMat3::ZERO);
        for i in 0..count {
            for j in 0..=i {
                let block = self.patch.compliance(i, j) * (1.0 / self.young_modulus);
                self.between[i * count + j] = block;
                self.between[j * count + i] = block.transpose();
            }
        }
    }

    /// How a slot gives way to forces on all, m/N.
    #[inline]
    pub(super) fn between(&self, slot: usize) -> &[DMat3] {
        let count = self.slots().len();
        &self.between[slot * count..][..count]
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
