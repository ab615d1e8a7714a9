//! RealtimeKit: the service that gives ordinary users of Linux desktops real-time priority.
//!
//! It grants `SCHED_RR` or `SCHED_FIFO` (with reset on fork) to a thread whose process has limited
//! `RLIMIT_RTTIME`, the processor time that a real-time thread may take without sleeping.

use std::io;
use std::time::{Duration, Instant};

use crate::clock::realtime::bus::{Bus, Service};
use crate::clock::realtime::runaway;

/// All of it, a start of the service included: a start must not wait for long.
const PATIENCE: Duration = Duration::from_secs(1);
const SYSTEM_BUS: &str =
    "unix:path=/run/dbus/system_bus_socket;unix:path=/var/run/dbus/system_bus_socket";
const KIT: Service = Service {
    name: "org.freedesktop.RealtimeKit1",
    path: "/org/freedesktop/RealtimeKit1",
    interface: "org.freedesktop.RealtimeKit1",
};
const WANTED_NICE: i32 = -11;

/// Priority that the service granted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Granted {
    /// A real-time priority.
    RealTime(i32),
    /// A high priority among ordinary threads, as a nice level.
    Nice(i32),
}

/// Asks for the calling thread, at most for `priority`.
///
/// # Errors
/// When there is no such service, or it refuses both; the words are for people.
pub fn ask(thread: libc::pid_t, priority: i32) -> io::Result<Granted> {
    let address = std::env::var("DBUS_SYSTEM_BUS_ADDRESS");
    let deadline = Instant::now() + PATIENCE;
    let bus = Bus::connect(address.as_deref().unwrap_or(SYSTEM_BUS), deadline)?;
    let refused = match real_time(&bus, thread, priority) {
        Ok(granted) => return Ok(granted),
        Err(refused) => refused,
    };
    // The reason for refusing real time says more than the second refusal would.
    nice(&bus, thread).map_err(|_| refused)
}

fn real_time(bus: &Bus, thread: libc::pid_t, priority: i32) -> io::Result<Granted> {
    let most = bus.integer(&KIT, "MaxRealtimePriority")?;
    let limit_us = bus.integer(&KIT, "RTTimeUSecMax")?;
    let priority = i64::from(priority).min(most);
    if priority < 1 || limit_us < 1 {
        return Err(io::Error::other("it grants no real-time priority"));
    }
    let guarded = runaway::guard(thread, limit_us as libc::rlim_t)?;
    let arguments = (thread as u64, priority as u32);
    match bus.call(&KIT, "MakeThreadRealtime", arguments) {
        Ok(()) => Ok(Granted::RealTime(priority as i32)),
        Err(refused) => {
            guarded.undo();
            Err(refused)
        }
    }
}

fn nice(bus: &Bus, thread: libc::pid_t) -> io::Result<Granted> {
    let least = bus.integer(&KIT, "MinNiceLevel")?;
    let level = i64::from(WANTED_NICE).max(least) as i32;
    let () = bus.call(&KIT, "MakeThreadHighPriority", (thread as u64, level))?;
    Ok(Granted::Nice(level))
}
