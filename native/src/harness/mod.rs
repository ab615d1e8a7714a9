//! Closed loops for tests and benchmarks; never in the package.

pub mod closed_loop;
pub mod plant;
