//! Whether there may be force, and how much a motor can hold.

pub mod coupling;
pub mod passivity;
pub mod safety;
pub mod state;
