//! Suspension of the computer: time that the clock of the ticks does not count.
//!
//! On Linux and macOS the clocks by which threads sleep stand still while the computer does. Without
//! this, the tick after an hour of sleep would look like any other.

/// Two readings of a clock further apart than this were interrupted, ns.
#[cfg(any(target_os = "linux", target_os = "macos"))]
const TOGETHER_NS: u64 = 1_000_000;

/// Time slept since it was made.
#[derive(Debug)]
pub struct Suspension {
    start_ns: u64,
    slept_ns: u64,
}

impl Default for Suspension {
    fn default() -> Self {
        let start_ns = std::iter::repeat_with(offset_ns).take(100).flatten().next();
        Self::since(start_ns.unwrap_or(u64::MAX))
    }
}

impl Suspension {
    fn since(start_ns: u64) -> Self {
        Self {
            start_ns,
            slept_ns: 0,
        }
    }

    /// Time slept, s; never less than the last time. Two or three readings of clocks.
    pub fn seconds(&mut self) -> f64 {
        self.update(offset_ns())
    }

    fn update(&mut self, offset_ns: Option<u64>) -> f64 {
        let slept_ns = offset_ns.map_or(0, |offset| offset.saturating_sub(self.start_ns));
        self.slept_ns = self.slept_ns.max(slept_ns);
        self.slept_ns as f64 * 1e-9
    }
}

/// Lead of the clock that goes on over the one that stops, ns; None if the thread was
/// interrupted between the readings, or if the system cannot tell.
#[cfg(target_os = "linux")]
fn offset_ns() -> Option<u64> {
    let read = |clock| {
        let mut t = libc::timespec {
            tv_sec: 0,
            tv_nsec: 0,
        };
        // SAFETY: `t` is valid for writing.
        let done = unsafe { libc::clock_gettime(clock, &raw mut t) };
        (done == 0).then_some(t.tv_sec as u64 * 1_000_000_000 + t.tv_nsec as u64)
    };
    let before = read(libc::CLOCK_MONOTONIC)?;
    let going_on = read(libc::CLOCK_BOOTTIME)?;
    let after = read(libc::CLOCK_MONOTONIC)?;
    (after - before < TOGETHER_NS).then_some(going_on.saturating_sub(before))
}

#[cfg(target_os = "macos")]
fn offset_ns() -> Option<u64> {
    use crate::clock::timebase::Timebase;
    unsafe extern "C" {
        fn mach_absolute_time() -> u64;
        fn mach_continuous_time() -> u64;
    }
    let base = Timebase::of_the_system();
    // SAFETY: these read clocks.
    let (before, going_on, after) = unsafe {
        (
            mach_absolute_time(),
            mach_continuous_time(),
            mach_absolute_time(),
        )
    };
    (base.ns(after - before) < TOGETHER_NS).then(|| base.ns(going_on.saturating_sub(before)))
}

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
fn offset_ns() -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sleep_is_counted_once_and_an_interrupted_reading_is_not() {
        let mut suspension = Suspension::since(5_000_000_000);
        let mut told = |offset| suspension.update(offset);
        assert_eq!(told(Some(5_000_000_000)), 0.0);
        assert_eq!(told(None), 0.0);
        assert_eq!(told(Some(4_999_999_000)), 0.0);
        assert_eq!(told(Some(3_605_000_000_000)), 3600.0);
        assert_eq!(told(Some(3_604_999_999_000)), 3600.0);
        assert_eq!(told(None), 3600.0);
    }

    #[test]
    fn where_nothing_is_known_nothing_is_told() {
        assert_eq!(Suspension::since(u64::MAX).update(Some(7)), 0.0);
    }

    #[test]
    fn a_computer_that_is_awake_has_not_slept() {
        let mut suspension = Suspension::default();
        for _ in 0..1000 {
            // Two clocks that are read one after the other are never quite at one.
            assert!(suspension.seconds() < 1.1e-3);
        }
    }
}
