//! Places of the proxy: in free space, inside the body, or on a triangle, an edge or a node.

use crate::body::face::HalfEdge;

/// Area coordinates below this are exact zeros: the proxy then stands *on* the edge or node, and
/// no step of the walk is too short to be told from rounding. It moves along the surface only.
pub(super) const BORDER: f64 = 1e-12;

/// Place of the god object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Place {
    /// In free space; the surface is farther than `clearance` from the last query point, and for
    /// `blind` more flights sweeps alone may decide.
    Free {
        clearance: f64,
        blind: u8,
    },
    /// Set down inside the body: feels nothing until it was outside once.
    Buried {
        clearance: f64,
    },
    Face {
        triangle: u32,
    },
    /// `part` of the way along a half-edge, strictly between its ends.
    Edge {
        edge: HalfEdge,
        part: f64,
    },
    Corner {
        triangle: u32,
        corner: u8,
    },
}

/// A point of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Triangle that carries the contact.
    pub triangle: u32,
    /// Area coordinates; exact zeros on edges and nodes.
    pub alpha: [f64; 3],
}

impl Place {
    /// Place of a surface point whose area coordinates are snapped.
    pub(super) fn of(hold: SurfacePoint) -> Self {
        let SurfacePoint { triangle, alpha } = hold;
        let corner = |corner| Self::Corner { triangle, corner };
        let edge = |edge, part| Self::Edge {
            edge: HalfEdge { triangle, edge },
            part,
        };
        match alpha.map(|a| a == 0.0) {
            [false, true, true] => corner(0),
            [true, false, true] => corner(1),
            [true, true, false] => corner(2),
            [false, false, true] => edge(0, alpha[1]),
            [true, false, false] => edge(1, alpha[2]),
            [false, true, false] => edge(2, alpha[0]),
            _ => Self::Face { triangle },
        }
    }
}

/// Area coordinates whose smallest parts are exact zeros.
pub(super) fn snap(alpha: [f64; 3]) -> [f64; 3] {
    let alpha = alpha.map(|a| if a < BORDER { 0.0 } else { a });
    let sum = alpha[0] + alpha[1] + alpha[2];
    alpha.map(|a| a / sum)
}
