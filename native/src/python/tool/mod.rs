//! Tools from numpy arrays.

pub mod made;
mod near_field;
pub mod shape;
pub mod surface;
pub mod told;
