//! The best clock and the best sleep each system gives, and real-time priority where it may be had.

#[cfg(target_os = "linux")]
mod system {
    /// `clock_nanosleep` on the monotonic clock.
    #[derive(Debug)]
    pub struct Sleeper;

    impl Sleeper {
        pub fn new() -> Self {
            Self
        }

        pub fn now_ns(&self) -> u64 {
            let mut t = libc::timespec {
                tv_sec: 0,
                tv_nsec: 0,
            };
            // SAFETY: `t` is valid for writing; the monotonic clock always exists.
            unsafe { libc::clock_gettime(libc::CLOCK_MONOTONIC, &raw mut t) };
            t.tv_sec as u64 * 1_000_000_000 + t.tv_nsec as u64
        }

        pub fn sleep_until(&self, deadline_ns: u64) {
            let t = libc::timespec {
                tv_sec: (deadline_ns / 1_000_000_000) as libc::time_t,
                tv_nsec: (deadline_ns % 1_000_000_000) as libc::c_long,
            };
            // SAFETY: `t` is valid for reading; no remainder is asked for with absolute times.
            while unsafe {
                libc::clock_nanosleep(
                    libc::CLOCK_MONOTONIC,
                    libc::TIMER_ABSTIME,
                    &raw const t,
                    std::ptr::null_mut(),
                )
            } == libc::EINTR
            {}
        }
    }

    const WANTED_PRIORITY: libc::c_int = 20;

    pub fn ask_for_real_time(_rate_hz: u32) -> String {
        // SAFETY: sets this thread's timer slack; no memory is involved.
        unsafe { libc::prctl(libc::PR_SET_TIMERSLACK, 1_usize) };
        let Err(first) = set_fifo(WANTED_PRIORITY) else {
            return format!("fifo {WANTED_PRIORITY}");
        };
        let mut limit = libc::rlimit {
            rlim_cur: 0,
            rlim_max: 0,
        };
        // SAFETY: `limit` is valid for writing.
        let known = unsafe { libc::getrlimit(libc::RLIMIT_RTPRIO, &raw mut limit) } == 0;
        let allowed = if known {
            limit.rlim_cur.min(WANTED_PRIORITY as libc::rlim_t) as libc::c_int
        } else {
            0
        };
        if allowed > 0 && set_fifo(allowed).is_ok() {
            return format!("fifo {allowed}");
        }
        format!("none: {first} (the rtprio limit is {})", limit.rlim_cur)
    }

    fn set_fifo(priority: libc::c_int) -> std::io::Result<()> {
        let parameters = libc::sched_param {
            sched_priority: priority,
        };
        let policy = libc::SCHED_FIFO | libc::SCHED_RESET_ON_FORK;
        // SAFETY: `parameters` is valid for reading; 0 means this thread.
        if unsafe { libc::sched_setscheduler(0, policy, &raw const parameters) } == 0 {
            Ok(())
        } else {
            Err(std::io::Error::last_os_error())
        }
    }
}

#[cfg(windows)]
mod system {
    use std::time::Instant;

    use windows_sys::Win32::Foundation::{CloseHandle, HANDLE};
    use windows_sys::Win32::System::Threading::{
        CREATE_WAITABLE_TIMER_HIGH_RESOLUTION, CreateWaitableTimerExW, INFINITE, SetWaitableTimer,
        TIMER_ALL_ACCESS, WaitForSingleObject,
    };

    /// A high-resolution waitable timer (Windows 10 1803 and later), else an ordinary one.
    #[derive(Debug)]
    pub struct Sleeper {
        origin: Instant,
        timer: HANDLE,
    }

    impl Sleeper {
        pub fn new() -> Self {
            let create = |flags| {
                // SAFETY: no attributes and no name are passed.
                unsafe {
                    CreateWaitableTimerExW(
                        std::ptr::null(),
                        std::ptr::null(),
                        flags,
                        TIMER_ALL_ACCESS,
                    )
                }
            };
            let mut timer = create(CREATE_WAITABLE_TIMER_HIGH_RESOLUTION);
            if timer.is_null() {
                timer = create(0);
            }
            Self {
                origin: Instant::now(),
                timer,
            }
        }

        pub fn now_ns(&self) -> u64 {
            self.origin.elapsed().as_nanos() as u64
        }

        pub fn sleep_until(&self, deadline_ns: u64) {
            let left = deadline_ns.saturating_sub(self.now_ns());
            if left == 0 {
                return;
            }
            // Negative means relative, in units of 100 ns.
            let due = -((left / 100) as i64).max(1);
            // SAFETY: the timer belongs to this object; `due` is valid for reading.
            let set = !self.timer.is_null()
                && unsafe {
                    SetWaitableTimer(self.timer, &raw const due, 0, None, std::ptr::null(), 0)
                } != 0;
            if set {
                // SAFETY: the timer belongs to this object.
                unsafe { WaitForSingleObject(self.timer, INFINITE) };
            } else {
                std::thread::sleep(std::time::Duration::from_nanos(left));
            }
        }
    }

    impl Drop for Sleeper {
        fn drop(&mut self) {
            if !self.timer.is_null() {
                // SAFETY: the timer belongs to this object and is not used again.
                unsafe { CloseHandle(self.timer) };
            }
        }
    }

    pub use super::audio::ask_for_real_time;
}

#[cfg(target_os = "macos")]
mod system {
    #[repr(C)]
    struct Timebase {
        numerator: u32,
        denominator: u32,
    }

    unsafe extern "C" {
        fn mach_absolute_time() -> u64;
        fn mach_timebase_info(info: *mut Timebase) -> i32;
        fn mach_wait_until(deadline: u64) -> i32;
    }

    /// `mach_wait_until` on the absolute clock.
    #[derive(Debug)]
    pub struct Sleeper {
        numerator: u64,
        denominator: u64,
    }

    impl Sleeper {
        pub fn new() -> Self {
            let mut base = Timebase {
                numerator: 1,
                denominator: 1,
            };
            // SAFETY: `base` is valid for writing.
            unsafe { mach_timebase_info(&raw mut base) };
            Self {
                numerator: u64::from(base.numerator.max(1)),
                denominator: u64::from(base.denominator.max(1)),
            }
        }

        pub fn now_ns(&self) -> u64 {
            // SAFETY: reads a clock.
            let ticks = u128::from(unsafe { mach_absolute_time() });
            (ticks * u128::from(self.numerator) / u128::from(self.denominator)) as u64
        }

        pub fn sleep_until(&self, deadline_ns: u64) {
            let ticks =
                u128::from(deadline_ns) * u128::from(self.denominator) / u128::from(self.numerator);
            // SAFETY: waits; an interruption only shortens the wait.
            unsafe { mach_wait_until(ticks as u64) };
        }
    }

    pub use super::audio::ask_for_real_time;
}

#[cfg(not(any(target_os = "linux", target_os = "macos", windows)))]
compile_error!("palpate_servo knows the clocks of Linux, macOS and Windows only");

/// Multimedia class on Windows, time constraint on macOS.
#[cfg(not(target_os = "linux"))]
mod audio {
    pub fn ask_for_real_time(rate_hz: u32) -> String {
        const SAMPLE_RATE: u32 = 48_000;
        let frames = (SAMPLE_RATE / rate_hz.max(1)).max(1);
        match audio_thread_priority::promote_current_thread_to_real_time(frames, SAMPLE_RATE) {
            Ok(_) if cfg!(windows) => "multimedia class".to_owned(),
            Ok(_) => "time constraint".to_owned(),
            Err(error) => format!("none: {error}"),
        }
    }
}

pub use system::Sleeper;

/// Asks the system for real-time priority for the calling thread; says what it gave.
pub fn ask_for_real_time(rate_hz: u32) -> String {
    system::ask_for_real_time(rate_hz)
}
