//! What only tests and benchmarks need.

pub mod closed_loop;
pub mod plant;
