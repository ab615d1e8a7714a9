//! A body from numpy arrays.

pub mod compliance;
pub mod surface;
