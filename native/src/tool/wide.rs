//! Loops over plain numbers, compiled for the wide registers that most processors have.
//!
//! Sums are added up in the order that the code says and products are rounded before: the result is
//! the same, bit for bit, with and without.

/// Calls a function marked `#[inline(always)]`, with wide registers where the processor has them.
macro_rules! widely {
    ($work:ident($($argument:expr),* $(,)?)) => {{
        #[cfg(target_arch = "x86_64")]
        {
            if std::arch::is_x86_feature_detected!("avx2") {
                let work = $crate::tool::wide::With(move || $work($($argument),*));
                // SAFETY: the processor has what the function is compiled for.
                unsafe { work.wide() }
            } else {
                $work($($argument),*)
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            $work($($argument),*)
        }
    }};
}

pub(super) use widely;

/// Work to be compiled twice.
#[cfg(target_arch = "x86_64")]
pub(super) struct With<F>(pub(super) F);

#[cfg(target_arch = "x86_64")]
impl<T, F: FnOnce() -> T> With<F> {
    /// # Safety
    /// The processor has AVX2.
    #[target_feature(enable = "avx2")]
    pub(super) unsafe fn wide(self) -> T {
        (self.0)()
    }
}
