//! Several fingers on one body.

pub mod felt_coupling;
pub mod several;
mod softened;
