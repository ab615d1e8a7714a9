//! The body's own material on its own nodes: energy and forces of a law in domains of any formulation,
//! relaxed under forces. Single-threaded, nothing is allocated after the start; no unit but of the body at 1 Pa.
//!
//! Bodies are prepared in `core/shape/`, which has the strains, the factors and the laws' tangents.

pub mod domains;
pub mod factor;
pub mod four;
mod history;
pub mod law;
pub mod load;
pub mod relaxation;
mod search;
pub mod strained;
mod turns;
pub mod warp;
