//! Where a body can be touched: by all, and by hands, which may ask for closer points.

use std::sync::Arc;

use super::{Point, ToolSurface};

/// Contact points of a body, and behind them in number those of hands.
#[derive(Debug, Clone)]
pub struct Touchable {
    own: Arc<ToolSurface>,
    by_hands: Option<Arc<ToolSurface>>,
}

impl Touchable {
    /// Without points of their own hands touch the same ones as all else.
    pub fn new(own: Arc<ToolSurface>, by_hands: Option<Arc<ToolSurface>>) -> Self {
        Self { own, by_hands }
    }

    /// The points that all but hands touch.
    #[inline]
    pub fn own(&self) -> &Arc<ToolSurface> {
        &self.own
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        let closer = self
            .by_hands
            .as_ref()
            .map_or(0, |closer| closer.points().len());
        self.own.points().len() + closer
    }

    /// The points that a hand can touch, or all else, and the number of their first.
    #[inline]
    pub fn of(&self, by_hand: bool) -> (&ToolSurface, u32) {
        match &self.by_hands {
            Some(closer) if by_hand => (closer, self.own.points().len() as u32),
            _ => (&self.own, 0),
        }
    }

    /// Whether a contact point is one of hands alone.
    #[inline]
    pub fn is_of_hands(&self, point: u32) -> bool {
        point as usize >= self.own.points().len()
    }

    /// What is fixed at a contact point.
    #[inline]
    pub fn point(&self, point: u32) -> &Point {
        let (surface, first) = self.of(self.is_of_hands(point));
        &surface.points()[(point - first) as usize]
    }

    /// How far points are apart around a contact point, m.
    #[inline]
    pub fn spacing(&self, point: u32) -> f64 {
        self.of(self.is_of_hands(point)).0.spacing()
    }
}
