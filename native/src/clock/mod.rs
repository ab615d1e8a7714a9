//! When a tick runs, and what is known about keeping its deadlines.

pub mod cpu_time;
pub mod durations;
pub(crate) mod realtime;
mod schedule;
mod sleeper;
pub(crate) mod suspension;
pub mod timing;
mod wake_margin;
