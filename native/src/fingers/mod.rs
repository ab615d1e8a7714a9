//! Several fingers on one body.

pub mod felt_coupling;
pub mod press;
pub mod several;
mod softened;
