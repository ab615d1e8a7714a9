//! A tool on a body alone, tick by tick; as the servo's fingers have it.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use glam::DVec3;

use super::Engine;
use super::joint::Led;
use crate::contact::ground::Ground;
use crate::creep::step::Step;
use crate::tool::collider::{Collider, Felt, NotANumber};
use crate::tool::points::ToolSurface;
use crate::tool::shape::{Pose, Tool};

/// A tool that no other finger is beside.
#[derive(Debug, Clone)]
pub struct LoneTool {
    surface: Arc<ToolSurface>,
    collider: Collider,
    engine: Engine,
}

impl LoneTool {
    /// A tool that was not yet set down.
    pub fn new(surface: Arc<ToolSurface>, tool: Tool) -> Self {
        Self {
            collider: Collider::new(surface.clone(), tool),
            surface,
            engine: Engine::default(),
        }
    }

    /// The contact points.
    pub fn surface(&self) -> &Arc<ToolSurface> {
        &self.surface
    }

    /// Nodes that carry force, and their forces at unit modulus.
    pub fn nodal_forces(&self) -> &[(u32, DVec3)] {
        self.collider.nodal_forces(0)
    }

    /// What the last tick found; nothing where that was no number.
    pub fn felt(&self) -> Felt {
        self.collider.felt().copied().unwrap_or_default()
    }

    /// One tick: the tool goes towards a pose by at most one stride, and feels the body there.
    ///
    /// # Errors
    /// [`NotANumber`] anywhere, or friction that is none: the contact is let go.
    pub fn follow(&mut self, goal: &Pose, young_modulus: f64) -> Result<&Felt, NotANumber> {
        if !(young_modulus > 0.0 && young_modulus.is_finite()) {
            self.collider.lift();
            return Err(NotANumber);
        }
        let body = Arc::clone(self.surface.body());
        let ground = Ground {
            body: &body,
            number: 0,
            young_modulus,
            mobility: None,
            creep: Step::default(),
        };
        let mut led = [const { None }; crate::contact::ground::MOST_TOOLS];
        led[0] = Some(Led {
            collider: &mut self.collider,
            goal: *goal,
            presence: 1.0,
        });
        let presses = [None; crate::contact::cones::MAX_FINGERS];
        self.engine.tick(&[ground], &presses, &mut led);
        self.collider.felt()
    }
}

impl Deref for LoneTool {
    type Target = Collider;

    fn deref(&self) -> &Collider {
        &self.collider
    }
}

impl DerefMut for LoneTool {
    fn deref_mut(&mut self) -> &mut Collider {
        &mut self.collider
    }
}
