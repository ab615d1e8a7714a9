//! The running thread, its settings and what it tells.

pub mod counters;
pub mod laying;
pub mod refusals;
pub mod samples;
pub mod settings;
pub mod snapshot;
pub mod standing;
pub mod started;
pub mod starting;
pub mod thread;
pub mod told;
