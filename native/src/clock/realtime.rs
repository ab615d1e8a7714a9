//! Real-time priority by what each system gives ordinary users.

#[cfg(target_os = "linux")]
mod bus;
#[cfg(not(target_os = "linux"))]
mod elsewhere;
#[cfg(target_os = "linux")]
mod linux;
#[cfg(target_os = "linux")]
mod rtkit;
#[cfg(target_os = "linux")]
mod runaway;

#[cfg(not(target_os = "linux"))]
use elsewhere as system;
#[cfg(target_os = "linux")]
use linux as system;

pub use system::Granted;

/// Real-time priority for the thread that asked, until this is dropped there.
#[derive(Debug)]
pub struct Tenure;

impl Drop for Tenure {
    fn drop(&mut self) {
        system::leave();
    }
}

/// Asks the system for real-time priority for the calling thread; says what it gave. May wait (a
/// second at most) and allocate: before the first tick, never in one.
pub fn ask_for_real_time(rate_hz: u32) -> (Granted, Tenure) {
    (system::ask(rate_hz), Tenure)
}
