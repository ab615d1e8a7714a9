//! Which device is asked for.

pub mod haply;
pub mod setups;
