//! CPU time of this thread.

/// Since the thread began, s.
///
/// Where the system keeps no such time finely enough (Windows counts in clock ticks of 16 ms), the
/// time that passed, which other threads make longer.
#[cfg(unix)]
pub fn thread_seconds() -> f64 {
    let mut time = libc::timespec {
        tv_sec: 0,
        tv_nsec: 0,
    };
    // SAFETY: the pointer is to a timespec of ours.
    let failed = unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    assert_eq!(failed, 0, "this system has no CPU time of a thread");
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Since some moment, s.
#[cfg(not(unix))]
pub fn thread_seconds() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}
