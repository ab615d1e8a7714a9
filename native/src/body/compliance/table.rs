//! Tables of numbers that somebody else owns, read in place.

use std::any::Any;
use std::fmt;
use std::ops::Deref;
use std::ptr::NonNull;
use std::slice;

/// A table of plain numbers, kept alive by whoever owns it.
///
/// The tables of a body take hundreds of megabytes, so they are not copied. Whatever addresses
/// memory (places, counts, numbers of blocks) does not belong in one of these: it is small, and must
/// stay as it was checked.
pub struct Table<T> {
    first: NonNull<T>,
    length: usize,
    // Dropped with the table; nothing else is done with it.
    _owner: Box<dyn Any + Send + Sync>,
}

// SAFETY: the table only reads, the owner may be shared and sent, and so may plain numbers.
unsafe impl<T: Send + Sync> Send for Table<T> {}
// SAFETY: as above.
unsafe impl<T: Send + Sync> Sync for Table<T> {}

impl<T> fmt::Debug for Table<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Table of {}", self.length)
    }
}

impl<T: Copy + Send + Sync + 'static> Table<T> {
    /// A table of `length` numbers from `first` on.
    ///
    /// # Safety
    /// `first` is aligned, and `length` numbers of type `T`, of which every pattern of bits is a
    /// valid one, can be read from it for as long as `owner` is not dropped. Nobody writes there.
    pub unsafe fn borrowed(
        first: NonNull<T>,
        length: usize,
        owner: impl Any + Send + Sync,
    ) -> Self {
        Self {
            first,
            length,
            _owner: Box::new(owner),
        }
    }
}

impl<T> Deref for Table<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        // SAFETY: by the promise of `borrowed`.
        unsafe { slice::from_raw_parts(self.first.as_ptr(), self.length) }
    }
}

impl<T: Copy + Send + Sync + 'static> From<Vec<T>> for Table<T> {
    fn from(mut numbers: Vec<T>) -> Self {
        let length = numbers.len();
        let first = NonNull::new(numbers.as_mut_ptr()).expect("a vector's pointer is never null");
        // SAFETY: the vector's memory stays where it is while the vector itself is moved.
        unsafe { Self::borrowed(first, length, numbers) }
    }
}
