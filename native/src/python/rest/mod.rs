//! Bodies that nobody holds.

pub mod prop;
pub mod resting;
