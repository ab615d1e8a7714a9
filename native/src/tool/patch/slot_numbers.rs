//! Which slot a contact point of a tool on a body has: a small table with open addressing (Knuth 6.4).

use crate::algebra::MOST_POINTS;

/// Places: more than twice as many as slots.
const PLACES: usize = (2 * MOST_POINTS).next_power_of_two();
const EMPTY: u64 = u64::MAX;

/// Slots by tool, body and contact point.
#[derive(Debug, Clone)]
pub(super) struct SlotNumbers {
    places: [(u64, u16); PLACES],
}

fn key([tool, body]: [u8; 2], point: u32) -> u64 {
    u64::from(tool) << 40 | u64::from(body) << 32 | u64::from(point)
}

fn home(key: u64) -> usize {
    (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 48) as usize % PLACES
}

impl SlotNumbers {
    pub(super) fn new() -> Self {
        Self {
            places: [(EMPTY, 0); PLACES],
        }
    }

    /// Where a key is, or where it would be.
    #[inline]
    fn place(&self, key: u64) -> usize {
        let mut place = home(key);
        while self.places[place].0 != key && self.places[place].0 != EMPTY {
            place = (place + 1) % PLACES;
        }
        place
    }

    #[inline]
    pub(super) fn of(&self, pair: [u8; 2], point: u32) -> Option<usize> {
        let (key, number) = (key(pair, point), self.place(key(pair, point)));
        let found = self.places[number];
        (found.0 == key).then(|| usize::from(found.1))
    }

    pub(super) fn set(&mut self, pair: [u8; 2], point: u32, slot: usize) {
        let key = key(pair, point);
        self.places[self.place(key)] = (key, slot as u16);
    }

    /// Those behind move up as far as they may, so that all are still found.
    pub(super) fn remove(&mut self, pair: [u8; 2], point: u32) {
        let mut hole = self.place(key(pair, point));
        let mut next = hole;
        loop {
            next = (next + 1) % PLACES;
            let (key, _) = self.places[next];
            if key == EMPTY {
                break;
            }
            let behind = |from: usize| (next + PLACES - from) % PLACES;
            if behind(home(key)) >= behind(hole) {
                self.places[hole] = self.places[next];
                hole = next;
            }
        }
        self.places[hole].0 = EMPTY;
    }
}
