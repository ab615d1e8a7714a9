//! Control of the force: whether there may be any, and how much stays stable with a motor.

pub mod coupling;
pub mod firmness;
pub mod lending;
pub mod passivity;
pub mod pressed;
pub mod safety;
pub mod state;
pub mod toll;
