//! Loops over plain numbers, compiled for the wide registers that most processors have.
//!
//! Sums are added up in the order that the code says and products are rounded before: the result is
//! the same, bit for bit, with and without.

/// A function that is compiled twice, with wide registers where the processor has them.
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
            fn work($($argument: $type),*) $(-> $result)? $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                unsafe fn wide($($argument: $type),*) $(-> $result)? {
                    work($($argument),*)
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    // SAFETY: the processor has what the function is compiled for.
                    return unsafe { wide($($argument),*) };
                }
            }
            work($($argument),*)
        }
    };
}

pub(crate) use widely;
