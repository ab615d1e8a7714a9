//! Tools from numpy arrays, and their contact.

pub mod contact;
mod near_field;
pub mod shape;
pub mod surface;
