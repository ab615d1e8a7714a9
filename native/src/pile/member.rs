//! A body of the pile: where it is, what presses it, how it gives way.

mod loading;

use std::sync::Arc;

use glam::DVec3;

use super::between::Between;
use super::outline::Surface;
use super::outline::looks::Looks;
use crate::algebra::MOST_POINTS;
use crate::body::surface::Body;
use crate::contact::cones::mean;
use crate::contact::ground::{Ground, MOST_TOOLS};
use crate::contact::mobility::{Mobility, Motion};
use crate::creep::step::Step;
use crate::rest::free_body::FreeBody;
use crate::rest::placement::Placement;
use crate::tool::patch::Patch;
use crate::tool::points::touchable::Touchable;
use crate::tool::slot::Slot;

/// No slot: the point is not looked at.
const NONE: u32 = u32::MAX;
/// Slots of a patch are of these numbers of a tool and body, by whose points they are: what presses
/// them is told by contacts.
const OWN: [u8; 2] = [0, 0];
const OF_HANDS: [u8; 2] = [1, 0];

/// A body of the pile.
#[derive(Debug, Clone)]
pub struct Member {
    /// Where it can be touched.
    pub touchable: Touchable,
    /// Pa.
    pub young_modulus: f64,
    /// Its mass and drag; none for one that is held.
    pub free: Option<FreeBody>,
    /// Where its frame is in the world.
    pub placement: Placement,
    /// Middle of its outline, how far that reaches, and its corners, m.
    pub(super) around: (DVec3, f64),
    outline: [DVec3; 2],
    /// How far a place gives way to a force, about, m/N at unit modulus.
    gives: f64,
    looks: Arc<Looks>,
    patch: Patch,
    /// The slot of each contact point, or none.
    slot_of: Vec<u32>,
    between: Between,
    /// Points that are to be looked at, and in which turn each was last.
    wanted: Vec<u32>,
    wanted_in: Vec<u32>,
    turn: u32,
    /// How wrenches in N move it in this tick; not at all where it is held.
    pub(super) mobility: Option<Mobility>,
    /// How it moved as a whole in the last one, in its frame.
    pub motion: Motion,
}

impl Member {
    /// A body that nothing presses yet.
    pub fn new(
        touchable: Touchable,
        young_modulus: f64,
        free: Option<FreeBody>,
        placement: Placement,
    ) -> Self {
        let count = touchable.count();
        let nodes = &touchable.own().body().nodes;
        let low = nodes.iter().fold(DVec3::INFINITY, |low, &at| low.min(at));
        let high = (nodes.iter()).fold(DVec3::NEG_INFINITY, |high, &at| high.max(at));
        let middle = (low + high) * 0.5;
        let reach = (nodes.iter()).fold(0.0_f64, |most, at| most.max(at.distance(middle)));
        let stiffness: f64 = (touchable.own().body().contact_blocks.iter().map(mean)).sum();
        Self {
            gives: nodes.len() as f64 / stiffness,
            slot_of: vec![NONE; count],
            wanted: Vec::with_capacity(MOST_POINTS),
            wanted_in: vec![0; count],
            turn: 0,
            mobility: None,
            motion: Motion::default(),
            looks: Arc::new(Looks::new(touchable.own().body())),
            touchable,
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
        self.touchable.own().body()
    }

    /// Its surface as others meet it.
    #[inline]
    pub(super) fn surface(&self) -> Surface<'_> {
        Surface {
            body: self.body(),
            looks: &self.looks,
        }
    }

    /// The contact point of a slot.
    #[inline]
    fn point_of(&self, slot: &Slot) -> u32 {
        self.touchable.of(slot.tool == OF_HANDS[0]).1 + slot.point
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
        let at = self.touchable.point(point).position;
        self.placement.to_world(at + self.moved(point))
    }

    /// Begins anew to say at which points to look.
    pub(super) fn begin_wanting(&mut self) {
        self.wanted.clear();
        self.turn = self.turn.wrapping_add(1);
    }

    /// Whether a point is to be looked at.
    #[inline]
    pub(super) fn wants(&self, point: u32) -> bool {
        self.wanted_in[point as usize] == self.turn
    }

    /// How many are to be looked at.
    #[inline]
    pub(super) fn wanted(&self) -> usize {
        self.wanted.len()
    }

    /// Has a point looked at, too.
    pub(super) fn want(&mut self, point: u32) {
        if !self.wants(point) {
            self.wanted_in[point as usize] = self.turn;
            self.wanted.push(point);
        }
    }

    /// Whether a point is looked at.
    #[inline]
    pub(super) fn looks_at(&self, point: u32) -> bool {
        self.slot_of[point as usize] != NONE
    }

    /// Looks at the points that are wanted, and no others.
    pub(super) fn look_at_wanted(&mut self) {
        for slot in (0..self.slots().len()).rev() {
            let point = self.point_of(&self.slots()[slot]);
            if !self.wants(point) {
                self.between.leave(slot, self.slots().len() - 1);
                self.patch.leave(slot);
                self.slot_of[point as usize] = NONE;
                if let Some(moved) = self.slots().get(slot) {
                    let moved = self.point_of(moved);
                    self.slot_of[moved as usize] = slot as u32;
                }
            }
        }
        let ground = Ground {
            body: &Arc::clone(self.touchable.own().body()),
            number: 0,
            young_modulus: self.young_modulus,
            creep: Step::default(),
            mobility: None,
        };
        self.wanted.sort_unstable();
        for &point in &self.wanted {
            if self.slot_of[point as usize] == NONE {
                let new = self.patch.slots().len();
                let is_of_hands = self.touchable.is_of_hands(point);
                let (surface, first) = self.touchable.of(is_of_hands);
                let pair = if is_of_hands { OF_HANDS } else { OWN };
                // Of two sets of points each knows the near field between its own alone.
                let mut kin = [false; MOST_TOOLS];
                kin[usize::from(pair[0])] = true;
                self.patch
                    .enter(&ground, surface, pair, point - first, &kin);
                self.slot_of[point as usize] = new as u32;
                let patch = &self.patch;
                self.between.enter(new, |slot| patch.compliance(slot, new));
            }
        }
    }

    /// How the slots give way to forces on each other.
    #[inline]
    pub(super) fn between(&self) -> &Between {
        &self.between
    }

    /// What its weight can give back, J, from the height of the world's origin on.
    pub(super) fn raised(&self, gravity: DVec3) -> f64 {
        let lift = |free: FreeBody| free.mass * gravity.dot(self.placement.to_world(free.centre));
        self.free.map_or(0.0, |free| -lift(free))
    }

    /// Begins a tick of `dt` s.
    pub(super) fn begin(&mut self, gravity: DVec3, dt: f64) {
        let own = self.placement.direction_to_body(gravity);
        self.mobility = self.free.map(|free| free.mobility(own, 1.0, dt));
        for slot in self.patch.slots_mut() {
            slot.arm = slot.at.position + slot.moved;
        }
    }

    /// How far a place of it went with it in the last tick at most, m; no more is told than contact
    /// points are apart.
    #[inline]
    pub(super) fn went(&self) -> f64 {
        let (middle, reach) = self.around;
        let reach = reach + middle.distance(self.motion.centre);
        self.motion.most(reach).min(self.touchable.own().spacing())
    }

    /// It moves as a whole by its weight and what presses it.
    pub(super) fn move_on(&mut self) {
        if self.mobility.is_none() {
            return;
        }
        self.motion = self.driven();
        if self.motion.is_finite() {
            self.placement = self.placement.moved(&self.motion);
        }
    }

    /// How its weight and what presses it move it as a whole in this tick.
    pub(super) fn driven(&self) -> Motion {
        let loads = self.slots().iter();
        let loads = loads.map(|slot| (slot.arm, slot.force * self.young_modulus));
        (self.mobility).map_or_else(Motion::default, |mobility| mobility.motion(loads))
    }

    /// Where a force acts that contact points share, m in the body's axes.
    #[inline]
    pub(super) fn arm(&self, shares: &[(u32, f64)]) -> DVec3 {
        let arms = shares.iter();
        arms.map(|&(point, share)| self.slots()[self.slot(point)].arm * share)
            .sum()
    }

    /// How far from its middle any of it is, m.
    #[inline]
    pub(super) fn reach(&self) -> f64 {
        self.around.1
    }

    /// Takes all memory that it ever needs while it looks at so many points at most.
    pub(super) fn reserve(&mut self, points: usize) {
        self.between.reserve(points);
        self.wanted.reserve(points);
        self.patch.reserve();
    }

    /// How far a place of it gives way to a force, about, m/N.
    pub(super) fn gives(&self) -> f64 {
        self.gives / self.young_modulus
    }
}
