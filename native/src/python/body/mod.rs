//! A body from numpy arrays.

pub mod closest;
pub mod compliance;
pub mod drawn;
pub mod place;
pub mod polygons;
pub mod surface;
