//! What benchmarks and tests need and the servo never does.

pub mod closed_loop;
