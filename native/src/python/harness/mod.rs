//! What only tests and benchmarks need.

pub mod closed_loop;
pub mod frames;
pub mod proxy;
pub mod several;
pub mod stepped;
pub mod stepped_fingers;
pub mod tick_cost;
pub mod tool_cost;
