//! Watchdog for real-time threads that never sleep: they lose the priority, the process lives.
//!
//! RealtimeKit wants a limit on the time that a real-time thread may run without sleeping
//! (`RLIMIT_RTTIME`). Beyond its soft value the kernel sends `SIGXCPU` and beyond the hard one
//! `SIGKILL`, both to the whole process, which is somebody else's: so the soft value lies below the
//! hard one, and the signal takes the priority from the servo's threads.

use std::io;
use std::mem::zeroed;
use std::ptr::{null, null_mut};
use std::sync::atomic::{AtomicI32, Ordering::SeqCst};

/// Threads that may be guarded at once; further ones stay without real-time priority.
const PLACES: usize = 16;
const NOBODY: libc::pid_t = 0;

static GUARDED: [AtomicI32; PLACES] = [const { AtomicI32::new(NOBODY) }; PLACES];

/// A guard that was set, and what was there before.
#[derive(Debug)]
pub struct Guarded {
    thread: libc::pid_t,
    before: libc::rlimit,
}

/// Sets the limit to at most `limit_us` and makes its signal take the priority from `thread`.
///
/// # Errors
/// When the system refuses, or somebody else's use of `SIGXCPU` is not known to be harmless.
pub fn guard(thread: libc::pid_t, limit_us: libc::rlim_t) -> io::Result<Guarded> {
    // SAFETY: all zeros is a valid limit.
    let mut before: libc::rlimit = unsafe { zeroed() };
    // SAFETY: `before` is valid for writing.
    checked(unsafe { libc::getrlimit(libc::RLIMIT_RTTIME, &raw mut before) })?;
    let place = |from, to| {
        GUARDED
            .iter()
            .any(|p| p.compare_exchange(from, to, SeqCst, SeqCst).is_ok())
    };
    if !place(NOBODY, thread) {
        return Err(io::Error::other(
            "too many threads have real-time priority already",
        ));
    }
    let guarded = Guarded { thread, before };
    let limit = libc::rlimit {
        rlim_cur: before.rlim_cur.min(limit_us / 2),
        rlim_max: before.rlim_max.min(limit_us),
    };
    // SAFETY: `limit` is valid for reading.
    let limited = handle_signal()
        .and_then(|()| checked(unsafe { libc::setrlimit(libc::RLIMIT_RTTIME, &raw const limit) }));
    if let Err(error) = limited {
        guarded.undo();
        return Err(error);
    }
    Ok(guarded)
}

impl Guarded {
    /// Takes the guard back. The system does not let ordinary users raise a hard limit again; the
    /// soft one, which is what the kernel acts upon first, is as it was or at the hard one.
    pub fn undo(self) {
        forget(self.thread);
        let whole = self.before;
        // SAFETY: the limits are valid for reading and writing.
        unsafe {
            if libc::setrlimit(libc::RLIMIT_RTTIME, &raw const whole) == 0 {
                return;
            }
            let mut now: libc::rlimit = zeroed();
            if libc::getrlimit(libc::RLIMIT_RTTIME, &raw mut now) == 0 {
                now.rlim_cur = whole.rlim_cur.min(now.rlim_max);
                libc::setrlimit(libc::RLIMIT_RTTIME, &raw const now);
            }
        }
    }
}

/// The thread ends: its number may soon be another's.
pub fn forget(thread: libc::pid_t) {
    for place in &GUARDED {
        let _ = place.compare_exchange(thread, NOBODY, SeqCst, SeqCst);
    }
}

fn checked(result: libc::c_int) -> io::Result<()> {
    if result == 0 {
        Ok(())
    } else {
        Err(io::Error::last_os_error())
    }
}

/// Takes `SIGXCPU` if nobody else has; whoever has one of his own lives with the signal already.
fn handle_signal() -> io::Result<()> {
    // SAFETY: all zeros is a valid action; both are valid for reading and writing.
    unsafe {
        let mut now: libc::sigaction = zeroed();
        checked(libc::sigaction(libc::SIGXCPU, null(), &raw mut now))?;
        if now.sa_sigaction != libc::SIG_DFL {
            return Ok(());
        }
        let mut ours: libc::sigaction = zeroed();
        ours.sa_sigaction = demote as *const () as libc::sighandler_t;
        ours.sa_flags = libc::SA_RESTART;
        checked(libc::sigaction(libc::SIGXCPU, &raw const ours, null_mut()))
    }
}

/// Only calls that are allowed in a handler: `sched_setscheduler` is a bare system call.
extern "C" fn demote(_signal: libc::c_int) {
    let ordinary = libc::sched_param { sched_priority: 0 };
    for place in &GUARDED {
        let thread = place.load(SeqCst);
        if thread != NOBODY {
            // SAFETY: the parameters are valid for reading; errno is put back for whom this
            // interrupts.
            unsafe {
                let errno = *libc::__errno_location();
                let policy = libc::SCHED_OTHER | libc::SCHED_RESET_ON_FORK;
                libc::sched_setscheduler(thread, policy, &raw const ordinary);
                *libc::__errno_location() = errno;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn policy(thread: libc::pid_t) -> libc::c_int {
        // SAFETY: asks about a number.
        unsafe { libc::sched_getscheduler(thread) & !libc::SCHED_RESET_ON_FORK }
    }

    #[test]
    fn a_thread_that_never_sleeps_loses_its_priority_and_nobody_dies() {
        let run = std::thread::spawn(|| {
            let parameters = libc::sched_param { sched_priority: 1 };
            // SAFETY: the parameters are valid for reading; 0 means this thread.
            let (me, refused) = unsafe {
                let me = libc::gettid();
                (
                    me,
                    libc::sched_setscheduler(0, libc::SCHED_FIFO, &raw const parameters) != 0,
                )
            };
            let guarded = guard(me, 100_000).expect("limits may be lowered");
            if refused {
                println!("skipped the spin: this user may not have real-time priority");
                // SAFETY: sends a signal to this thread, whose handler was just installed.
                unsafe { libc::raise(libc::SIGXCPU) };
            } else {
                while policy(me) != libc::SCHED_OTHER {
                    std::hint::spin_loop();
                }
            }
            guarded.undo();
            assert_eq!(policy(me), libc::SCHED_OTHER);
            assert!(GUARDED.iter().all(|p| p.load(SeqCst) != me));
        });
        run.join().expect("it lives");
    }
}
