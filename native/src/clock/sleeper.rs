//! Clock and sleep of each system, the most exact that it has.

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
}

#[cfg(windows)]
mod system {
    use std::sync::LazyLock;
    use std::time::Instant;

    use windows_sys::Win32::Foundation::{CloseHandle, HANDLE};
    use windows_sys::Win32::System::Threading::{
        CREATE_WAITABLE_TIMER_HIGH_RESOLUTION, CreateWaitableTimerExW, INFINITE, SetWaitableTimer,
        TIMER_ALL_ACCESS, WaitForSingleObject,
    };

    /// Zero of the clock, one for all threads: they hand each other times.
    static ORIGIN: LazyLock<Instant> = LazyLock::new(Instant::now);

    /// A high-resolution waitable timer (Windows 10 1803 and later), else an ordinary one.
    #[derive(Debug)]
    pub struct Sleeper {
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
            Self { timer }
        }

        pub fn now_ns(&self) -> u64 {
            ORIGIN.elapsed().as_nanos() as u64
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
}

#[cfg(target_os = "macos")]
mod system {
    use crate::clock::timebase::Timebase;

    unsafe extern "C" {
        fn mach_absolute_time() -> u64;
        fn mach_wait_until(deadline: u64) -> i32;
    }

    /// `mach_wait_until` on the absolute clock.
    #[derive(Debug)]
    pub struct Sleeper {
        base: Timebase,
    }

    impl Sleeper {
        pub fn new() -> Self {
            Self {
                base: Timebase::of_the_system(),
            }
        }

        pub fn now_ns(&self) -> u64 {
            // SAFETY: reads a clock.
            self.base.ns(unsafe { mach_absolute_time() })
        }

        pub fn sleep_until(&self, deadline_ns: u64) {
            // SAFETY: waits; an interruption only shortens the wait.
            unsafe { mach_wait_until(self.base.ticks(deadline_ns)) };
        }
    }
}

#[cfg(not(any(target_os = "linux", target_os = "macos", windows)))]
compile_error!("palpate_servo knows the clocks of Linux, macOS and Windows only");

pub use system::Sleeper;
