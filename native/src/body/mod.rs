//! The body: its rest surface, and how that gives way.

mod between_nodes;
pub mod closest;
pub mod compliance;
pub mod error;
pub mod face;
mod joining;
mod normals;
mod response;
pub mod surface;
pub mod sweep;
pub mod tree;
