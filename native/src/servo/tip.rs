//! What a finger touches with.

use crate::body::surface::Body;
use crate::tool::collider::Collider;

/// What touches the body.
#[derive(Debug, Default)]
pub enum Tip {
    /// A point.
    #[default]
    Point,
    /// A fingertip, rod, plate or hull.
    Tool(Box<Collider>),
}

impl Tip {
    /// Whether it can touch this body: a tool is made for one.
    pub fn fits(&self, body: &Body) -> bool {
        match self {
            Self::Point => true,
            Self::Tool(tool) => tool.is_on(body),
        }
    }
}
