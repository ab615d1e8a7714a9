//! Which device is asked for.

pub mod coupling;
pub mod haply;
pub mod setups;
