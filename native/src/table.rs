//! Numbers that somebody else owns, read in place.

use std::any::Any;
use std::fmt;
use std::ptr::NonNull;

/// A table of plain numbers, kept alive by whoever owns it.
///
/// The tables of a body take hundreds of megabytes, so they are not copied. Entries are read one
/// at a time and by value: no reference into the memory is ever made, so an owner that changes a
/// number in spite of its promise makes a wrong number, nothing worse. Whatever addresses memory
/// (places, counts, numbers of blocks) must not be kept in one of these.
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
    /// valid one, can be read from it for as long as `owner` is not dropped.
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

    /// How many numbers there are.
    #[inline]
    pub const fn len(&self) -> usize {
        self.length
    }

    /// Whether there are none.
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// The number at `place`.
    ///
    /// # Panics
    /// Beyond the end.
    #[inline]
    pub fn at(&self, place: usize) -> T {
        assert!(place < self.length, "{place} of {}", self.length);
        // SAFETY: within the table, by the promise of `borrowed`. Volatile: read once, as it is.
        unsafe { self.first.add(place).read_volatile() }
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
