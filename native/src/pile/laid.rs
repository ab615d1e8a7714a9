//! A body as one that nobody holds: alone, or among others that it presses.

use super::among::Among;
use crate::body::surface::Body;
use crate::rest::placement::Placement;
use crate::rest::prop::Prop;

/// A body that nobody holds, in the tick.
#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "there is one, in a box")]
pub enum Lying {
    /// On supports.
    Alone(Prop),
    /// On supports and other bodies, which move and give way, too.
    Among(Among),
}

/// A body as one that nobody holds, or none that is held.
pub type Laid = Option<Box<Lying>>;

impl Lying {
    /// Whether it is this body.
    pub fn is(&self, body: &Body) -> bool {
        match self {
            Self::Alone(prop) => prop.is(body),
            Self::Among(among) => std::ptr::eq(&raw const **among.body(), body),
        }
    }

    /// Whether it is among others.
    pub fn is_among(&self) -> bool {
        matches!(self, Self::Among(_))
    }

    /// Where it is.
    pub fn placement(&self) -> Placement {
        match self {
            Self::Alone(prop) => prop.placement,
            Self::Among(among) => among.placement(),
        }
    }

    /// What it can give back, J.
    pub fn stored(&self) -> f64 {
        match self {
            Self::Alone(prop) => prop.stored(),
            Self::Among(among) => among.stored(),
        }
    }
}
