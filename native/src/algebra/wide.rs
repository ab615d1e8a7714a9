//! Loops over plain numbers, compiled for the wide registers that most processors have.
//!
//! Sums are added up in the order that the code says. Where the processor adds a product in one step,
//! that is rounded once: results of processors with and without differ by rounding.

/// Sums that run beside each other, so that no addition waits for the one before.
pub(crate) const LANES: usize = 8;

/// Whether what is not compiled for wide registers adds products in one step.
pub(crate) const NARROW_FUSED: bool = cfg!(target_arch = "aarch64");

/// a b + c, rounded once where the processor does so in one step.
#[inline(always)]
pub(crate) fn plus_product<const FUSED: bool>(c: f64, a: f64, b: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { c + a * b }
}

/// A function that is compiled twice, with wide registers where the processor has them. In its body
/// `FUSED` says whether products are added in one step ([`plus_product`]).
///
/// What it calls is compiled with it only where that is `#[inline(always)]`. A closure is not: it is a
/// function of its own, and stays narrow unless the compiler happens to inline it.
macro_rules! widely {
    (
        $(#[$attribute:meta])*
        $visible:vis fn $name:ident($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? $body:block
    ) => {
        $(#[$attribute])*
        #[inline]
        $visible fn $name($($argument: $type),*) $(-> $result)? {
            #[inline(always)]
            fn work<const FUSED: bool>($($argument: $type),*) $(-> $result)? $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2,fma")]
                unsafe fn wide($($argument: $type),*) $(-> $result)? {
                    work::<true>($($argument),*)
                }
                if std::arch::is_x86_feature_detected!("avx2")
                    && std::arch::is_x86_feature_detected!("fma")
                {
                    // SAFETY: the processor has what the function is compiled for.
                    return unsafe { wide($($argument),*) };
                }
            }
            work::<{ $crate::algebra::wide::NARROW_FUSED }>($($argument),*)
        }
    };
}

pub(crate) use widely;

widely! {
    /// Adds so many times some numbers to others.
    pub(crate) fn add(times: f64, from: &[f64], to: &mut [f64]) {
        for (to, from) in to.iter_mut().zip(from) {
            *to = plus_product::<FUSED>(*to, times, *from);
        }
    }
}
