//! The body as the servo knows it: its rest surface and how that gives way.

pub mod closest;
pub mod compliance;
pub mod face;
mod joining;
mod normals;
mod response;
pub mod softening;
pub mod surface;
pub mod tree;
