//! The running thread, its settings and what it tells.

pub mod counters;
pub mod samples;
pub mod settings;
pub mod snapshot;
pub mod started;
pub mod thread;
