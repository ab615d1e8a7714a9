//! Quick hashes of a few small numbers that no stranger chooses.

use std::hash::{BuildHasherDefault, Hasher};

/// For sets and maps of such.
pub(crate) type Quick = BuildHasherDefault<QuickHasher>;

/// The golden ratio's part of all numbers, odd.
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

/// Multiplies number after number in.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct QuickHasher(u64);

impl Hasher for QuickHasher {
    #[inline]
    fn finish(&self) -> u64 {
        // The upper half is mixed best; tables take the lowest bits.
        self.0 ^ (self.0 >> 32)
    }

    #[inline]
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }

    #[inline]
    fn write_u32(&mut self, number: u32) {
        self.write_u64(u64::from(number));
    }

    #[inline]
    fn write_u64(&mut self, number: u64) {
        self.0 = (self.0.rotate_left(5) ^ number).wrapping_mul(SPREAD);
    }

    #[inline]
    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    #[inline]
    fn write_isize(&mut self, number: isize) {
        self.write_u64(number as u64);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::hash::Hash;

    use super::*;

    #[test]
    fn small_numbers_are_spread_over_all_of_a_table() {
        let hashes = (0..64_usize).flat_map(|body| {
            (0..64_u32).map(move |point| {
                let mut hasher = QuickHasher::default();
                (body, point, Some(body)).hash(&mut hasher);
                hasher.finish()
            })
        });
        let hashes: Vec<u64> = hashes.collect();
        let whole: HashSet<u64> = hashes.iter().copied().collect();
        assert_eq!(whole.len(), hashes.len());
        // As many as by chance in a table of as many places: 63 % of these.
        let low: HashSet<u64> = hashes.iter().map(|hash| hash % 4096).collect();
        let high: HashSet<u64> = hashes.iter().map(|hash| hash >> 52).collect();
        assert!(
            low.len() > 2300 && high.len() > 2300,
            "{} {}",
            low.len(),
            high.len()
        );
    }
}
