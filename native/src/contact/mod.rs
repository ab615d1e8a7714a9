//! From a displaced contact point to forces.

pub mod cones;
pub mod touch;
