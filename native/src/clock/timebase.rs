//! Ticks of macOS' clocks, which are nanoseconds on Intel's processors and 125 / 3 of them on Apple's.

/// Nanoseconds a tick, as a fraction (`mach_timebase_info_data_t`).
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub(super) struct Timebase {
    numerator: u32,
    denominator: u32,
}

impl Timebase {
    /// The system's own.
    #[cfg(target_os = "macos")]
    pub fn of_the_system() -> Self {
        unsafe extern "C" {
            fn mach_timebase_info(info: *mut Timebase) -> i32;
        }
        let mut base = Self {
            numerator: 1,
            denominator: 1,
        };
        // SAFETY: `base` is valid for writing.
        unsafe { mach_timebase_info(&raw mut base) };
        base
    }

    /// Time of so many ticks, ns, rounded down.
    pub fn ns(self, ticks: u64) -> u64 {
        let (n, d) = self.fraction();
        (u128::from(ticks) * n / d) as u64
    }

    /// The first tick at which so many ns have passed.
    pub fn ticks(self, ns: u64) -> u64 {
        let (n, d) = self.fraction();
        (u128::from(ns) * d).div_ceil(n) as u64
    }

    fn fraction(self) -> (u128, u128) {
        let part = |number: u32| u128::from(number.max(1));
        (part(self.numerator), part(self.denominator))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTELS: Timebase = Timebase {
        numerator: 1,
        denominator: 1,
    };
    const APPLES: Timebase = Timebase {
        numerator: 125,
        denominator: 3,
    };
    const YEAR_NS: u64 = 31_557_600_000_000_000;

    #[test]
    fn a_second_is_as_many_ticks_as_the_clock_counts() {
        assert_eq!(APPLES.ticks(1_000_000_000), 24_000_000);
        assert_eq!(APPLES.ns(24_000_000), 1_000_000_000);
        assert_eq!(INTELS.ticks(1_000_000_000), 1_000_000_000);
    }

    #[test]
    fn who_waits_for_a_deadline_wakes_at_the_first_tick_that_is_not_before_it() {
        for base in [INTELS, APPLES] {
            for deadline in (0..2_000).chain(YEAR_NS..YEAR_NS + 2_000) {
                let tick = base.ticks(deadline);
                assert!(base.ns(tick) >= deadline);
                assert!(tick == 0 || base.ns(tick - 1) < deadline);
            }
        }
    }

    #[test]
    fn a_computer_that_runs_for_years_has_room_for_its_time() {
        assert_eq!(APPLES.ns(APPLES.ticks(100 * YEAR_NS)), 100 * YEAR_NS);
    }

    #[test]
    fn what_the_system_does_not_tell_is_taken_for_nanoseconds() {
        let none = Timebase {
            numerator: 0,
            denominator: 0,
        };
        assert_eq!((none.ns(7), none.ticks(7)), (7, 7));
    }
}
