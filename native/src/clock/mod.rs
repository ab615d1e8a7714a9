//! Deadlines of the ticks: waiting for them, priority, and counters of how they were kept.

pub mod cpu_time;
pub mod durations;
pub(crate) mod realtime;
mod schedule;
mod sleeper;
pub(crate) mod suspension;
#[cfg(any(test, target_os = "macos"))]
mod timebase;
pub mod timing;
mod wake_margin;
