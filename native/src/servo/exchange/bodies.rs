//! A body handed to the servo's thread while it runs, and the old one taken back.
//!
//! Wait-free for the thread: it looks into a triple buffer. It only ever borrows; the old body is
//! freed by whoever handed over the new one, after the thread has said that it uses that.

use std::sync::Arc;

use triple_buffer::{Input, Output, triple_buffer};

use crate::body::surface::Body;

/// A body on its way.
#[derive(Clone)]
struct Handed {
    body: Arc<Body>,
    /// Counts the exchanges.
    number: u32,
    /// The settings that belong to it have been handed over too.
    settled: bool,
}

/// The end outside of the thread.
pub struct Hand {
    input: Input<Handed>,
    newest: Handed,
}

/// The thread's end.
pub struct Holder {
    output: Output<Handed>,
    number: u32,
}

/// Both ends, with a first body in use.
pub fn exchange(body: Arc<Body>) -> (Hand, Holder) {
    let newest = Handed {
        body,
        number: 0,
        settled: true,
    };
    let (input, output) = triple_buffer(&newest);
    (Hand { input, newest }, Holder { output, number: 0 })
}

impl Hand {
    /// Hands over a body, which is not felt before it is [`settled`](Self::settle); its number.
    pub fn give(&mut self, body: Arc<Body>) -> u32 {
        self.newest = Handed {
            body,
            number: self.newest.number.wrapping_add(1),
            settled: false,
        };
        self.input.write(self.newest.clone());
        self.newest.number
    }

    /// Says that the settings which belong to the body have been handed over.
    pub fn settle(&mut self) {
        self.newest.settled = true;
        self.input.write(self.newest.clone());
    }

    /// Frees all older bodies. Only after the thread has said that it uses the newest.
    pub fn forget_older(&mut self) {
        // One of the two places that the thread does not read is here, the other one behind it.
        self.input.write(self.newest.clone());
        *self.input.input_buffer_mut() = self.newest.clone();
    }
}

impl Holder {
    /// The body to touch, its number, and whether it is another one since the last call, or not
    /// settled yet. To be called before the settings are read: those of a settled body are there.
    pub fn newest(&mut self) -> (&Arc<Body>, u32, bool) {
        let handed = self.output.read();
        let is_other = std::mem::replace(&mut self.number, handed.number) != handed.number;
        (&handed.body, handed.number, is_other || !handed.settled)
    }
}
