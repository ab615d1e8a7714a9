//! Linux: `SCHED_FIFO` by right or by limit, RealtimeKit, and the best among ordinary threads.

use std::io;

use crate::clock::realtime::rtkit;
use crate::clock::realtime::runaway;

/// Above ordinary threads, below what the sound server and the kernel's own threads have.
const WANTED_PRIORITY: libc::c_int = 20;
/// The shortest slice that the scheduler takes, ns.
const SLICE_NS: u64 = 100_000;
const REMEDY: &str = "install rtkit, or allow your user an rtprio of 20 in /etc/security/limits.d";

/// Scheduling that the calling thread was given.
#[derive(Debug)]
pub struct Granted {
    text: String,
    thread: libc::pid_t,
    is_real_time: bool,
}

impl Granted {
    /// Text for people: the priority, or why there is none and what helps. A watchdog may take it back
    /// (ours, RealtimeKit's), so this looks again.
    pub fn text(&self) -> String {
        // SAFETY: asks about a number; a thread that has ended is an error.
        let policy = unsafe { libc::sched_getscheduler(self.thread) };
        if self.is_real_time && policy >= 0 && !is_real_time(policy) {
            format!(
                "none: {} was taken back, for something ran without end",
                self.text
            )
        } else {
            self.text.clone()
        }
    }
}

fn is_real_time(policy: libc::c_int) -> bool {
    let policy = policy & !libc::SCHED_RESET_ON_FORK;
    policy == libc::SCHED_FIFO || policy == libc::SCHED_RR
}

/// Asks for the calling thread. Takes a second at most, while a bus does not answer.
pub fn ask(_rate_hz: u32) -> Granted {
    // SAFETY: sets this thread's timer slack; no memory is involved.
    unsafe { libc::prctl(libc::PR_SET_TIMERSLACK, 1_usize) };
    let thread = this_thread();
    let text = by_right().unwrap_or_else(|refused| by_service(thread, &refused));
    // SAFETY: asks about this thread.
    let is_real_time = is_real_time(unsafe { libc::sched_getscheduler(0) });
    Granted {
        text,
        thread,
        is_real_time,
    }
}

/// The calling thread ends.
pub fn leave() {
    runaway::forget(this_thread());
}

/// The C library has a function for this only since glibc 2.30, and Blender needs but 2.28.
fn this_thread() -> libc::pid_t {
    // SAFETY: tells this thread's number; no memory is involved.
    unsafe { libc::syscall(libc::SYS_gettid) as libc::pid_t }
}

fn by_right() -> io::Result<String> {
    let refused = match set_fifo(WANTED_PRIORITY) {
        Ok(()) => return Ok(format!("fifo {WANTED_PRIORITY}")),
        Err(refused) => refused,
    };
    let allowed = allowed_priority();
    if allowed > 0 && set_fifo(allowed).is_ok() {
        return Ok(format!("fifo {allowed}"));
    }
    Err(refused)
}

fn by_service(thread: libc::pid_t, refused: &io::Error) -> String {
    let text = match rtkit::ask(thread, WANTED_PRIORITY) {
        Ok(rtkit::Granted::RealTime(priority)) => return format!("rtkit {}", fifo_or_rr(priority)),
        Ok(rtkit::Granted::Nice(level)) => format!("rtkit nice {level}"),
        Err(silent) => format!("none: {refused}; RealtimeKit: {silent}; {REMEDY}"),
    };
    // A thread with a short slice overtakes others with longer ones when it wakes.
    shorten_slice();
    text
}

/// RealtimeKit's administrator chooses which of the two it gives.
fn fifo_or_rr(priority: i32) -> String {
    // SAFETY: asks about this thread.
    let policy = unsafe { libc::sched_getscheduler(0) } & !libc::SCHED_RESET_ON_FORK;
    let name = match policy {
        libc::SCHED_FIFO => "fifo",
        libc::SCHED_RR => "rr",
        _ => "nothing",
    };
    format!("{name} {priority}")
}

/// Priority that the rtprio limit allows, once its soft value is raised to the hard one.
fn allowed_priority() -> libc::c_int {
    let mut limit = libc::rlimit {
        rlim_cur: 0,
        rlim_max: 0,
    };
    // SAFETY: `limit` is valid for reading and writing.
    unsafe {
        if libc::getrlimit(libc::RLIMIT_RTPRIO, &raw mut limit) != 0 {
            return 0;
        }
        if limit.rlim_cur < limit.rlim_max {
            let raised = libc::rlimit {
                rlim_cur: limit.rlim_max,
                ..limit
            };
            if libc::setrlimit(libc::RLIMIT_RTPRIO, &raw const raised) == 0 {
                limit = raised;
            }
        }
    }
    limit.rlim_cur.min(WANTED_PRIORITY as libc::rlim_t) as libc::c_int
}

fn set_fifo(priority: libc::c_int) -> io::Result<()> {
    let parameters = libc::sched_param {
        sched_priority: priority,
    };
    let policy = libc::SCHED_FIFO | libc::SCHED_RESET_ON_FORK;
    // SAFETY: `parameters` is valid for reading; 0 means this thread.
    if unsafe { libc::sched_setscheduler(0, policy, &raw const parameters) } == 0 {
        Ok(())
    } else {
        Err(io::Error::last_os_error())
    }
}

/// `struct sched_attr` of `sched_setattr(2)`, first version.
#[repr(C)]
#[derive(Debug, Default)]
struct SchedulingAttributes {
    size: u32,
    policy: u32,
    flags: u64,
    nice: i32,
    priority: u32,
    runtime: u64,
    deadline: u64,
    period: u64,
}

/// Takes the shortest slice of an ordinary thread. Linux before 6.12 knows none and changes
/// nothing.
fn shorten_slice() {
    let attributes = SchedulingAttributes {
        size: size_of::<SchedulingAttributes>() as u32,
        policy: libc::SCHED_OTHER as u32,
        // SAFETY: asks about this thread.
        nice: unsafe { libc::getpriority(libc::PRIO_PROCESS, 0) },
        runtime: SLICE_NS,
        ..SchedulingAttributes::default()
    };
    // SAFETY: the attributes are valid for reading and say their size; 0 means this thread. A
    // kernel that refuses leaves things as they were.
    unsafe { libc::syscall(libc::SYS_sched_setattr, 0, &raw const attributes, 0) };
}
