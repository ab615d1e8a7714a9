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

    /// What holds energy in it, and in others, beside fingers.
    pub fn held(&self) -> Beside {
        match self {
            Self::Alone(prop) => Beside {
                held: prop.held(),
                remembered: prop.remembered(),
                own: None,
            },
            Self::Among(among) => Beside {
                held: among.held(),
                remembered: 0.0,
                own: Some(among.elastic()),
            },
        }
    }

    /// What its weight can give back, and that of all others, J.
    pub fn raised(&self) -> f64 {
        match self {
            Self::Alone(prop) => prop.raised(),
            Self::Among(among) => among.raised(),
        }
    }
}

/// What holds energy in a body, and in others, beside its fingers, J.
#[derive(Debug, Clone, Copy, Default)]
pub struct Beside {
    /// What all else than fingers holds.
    pub held: f64,
    /// What that does on the displacements which the body remembers.
    pub remembered: f64,
    /// All that is held in the body itself, where fingers hold some in others, too.
    pub own: Option<f64>,
}
