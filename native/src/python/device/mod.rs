//! Devices as Python describes them.

pub mod coupling;
pub mod haply;
pub mod setups;
