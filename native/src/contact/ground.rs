//! A compliant body in a tick, one of a list.

use crate::body::surface::Body;

/// Compliant bodies that fingers can touch at once.
pub const MOST_BODIES: usize = 4;

/// A compliant body in a tick.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// The body.
    pub body: &'a Body,
    /// Another one for each body of the list, and for each that takes its place there.
    pub number: u32,
    /// Pa.
    pub young_modulus: f64,
}
