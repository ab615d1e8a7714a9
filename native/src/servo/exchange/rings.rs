//! Something that the thread uses, exchanged while it runs.
//!
//! Wait-free for the thread: two rings, one each way. What was used comes back over the second one, so
//! that the tick frees nothing.

use rtrb::{Consumer, Producer, RingBuffer};

/// As many are on their way at most.
const ON_THE_WAY: usize = 4;

/// The end outside of the thread.
pub struct Giver<T> {
    given: Producer<T>,
    back: Consumer<T>,
}

/// The thread's end.
pub struct Taker<T> {
    /// What is in use.
    pub held: T,
    given: Consumer<T>,
    back: Producer<T>,
}

/// Both ends, with something in use to begin with.
pub fn rings<T>(held: T) -> (Giver<T>, Taker<T>) {
    let (given_in, given) = RingBuffer::new(ON_THE_WAY);
    let (back, back_out) = RingBuffer::new(ON_THE_WAY);
    let giver = Giver {
        given: given_in,
        back: back_out,
    };
    (giver, Taker { held, given, back })
}

impl<T> Giver<T> {
    /// Hands something over; gives it back if too much is on its way already.
    ///
    /// # Errors
    /// The thing itself.
    pub fn give(&mut self, thing: T) -> Result<(), T> {
        (self.given.push(thing)).map_err(|rtrb::PushError::Full(thing)| thing)
    }

    /// Frees all that has come back; how many.
    pub fn free_old(&mut self) -> usize {
        std::iter::from_fn(|| self.back.pop().ok()).count()
    }
}

impl<T> Taker<T> {
    /// Takes the newest into use; whether it is another one. Neither waits nor frees.
    pub fn exchange(&mut self) -> bool {
        let mut is_other = false;
        while !self.back.is_full()
            && let Ok(thing) = self.given.pop()
        {
            let old = std::mem::replace(&mut self.held, thing);
            // There is room, and nobody else puts anything there.
            if let Err(rtrb::PushError::Full(old)) = self.back.push(old) {
                std::mem::forget(old);
            }
            is_other = true;
        }
        is_other
    }
}
