//! What a finger touches with, and its exchange while the servo runs.
//!
//! Wait-free for the thread: two rings, one each way. A tip that was used comes back over the second
//! one, so that the tick frees nothing.

use rtrb::{Consumer, Producer, RingBuffer};

use crate::body::surface::Body;
use crate::tool::collider::Collider;

/// What touches the body.
#[derive(Debug, Default)]
pub enum Tip {
    /// A point.
    #[default]
    Point,
    /// A fingertip, rod, plate or hull.
    Tool(Box<Collider>),
}

impl Tip {
    /// Whether it can touch this body: a tool is made for one.
    pub fn fits(&self, body: &Body) -> bool {
        match self {
            Self::Point => true,
            Self::Tool(tool) => tool.is_on(body),
        }
    }
}

/// Tips on their way at most.
const ON_THE_WAY: usize = 4;

/// The end outside of the thread.
pub struct TipHand {
    given: Producer<Tip>,
    back: Consumer<Tip>,
}

/// The thread's end, with the tip in use.
pub struct TipHolder {
    /// The tip in use.
    pub tip: Tip,
    given: Consumer<Tip>,
    back: Producer<Tip>,
}

/// Both ends, with a first tip in use.
pub fn exchange_tips(tip: Tip) -> (TipHand, TipHolder) {
    let (given_in, given) = RingBuffer::new(ON_THE_WAY);
    let (back, back_out) = RingBuffer::new(ON_THE_WAY);
    let hand = TipHand {
        given: given_in,
        back: back_out,
    };
    (hand, TipHolder { tip, given, back })
}

impl TipHand {
    /// Hands over a tip; gives it back if too many are on their way already.
    ///
    /// # Errors
    /// The tip itself.
    pub fn give(&mut self, tip: Tip) -> Result<(), Tip> {
        (self.given.push(tip)).map_err(|rtrb::PushError::Full(tip)| tip)
    }

    /// Frees all tips that have come back; how many.
    pub fn free_old(&mut self) -> usize {
        std::iter::from_fn(|| self.back.pop().ok()).count()
    }
}

impl TipHolder {
    /// Takes the newest tip into use; whether it is another one. Neither waits nor frees.
    pub fn exchange(&mut self) -> bool {
        let mut is_other = false;
        while !self.back.is_full()
            && let Ok(tip) = self.given.pop()
        {
            let old = std::mem::replace(&mut self.tip, tip);
            // There is room, and nobody else puts anything there.
            if let Err(rtrb::PushError::Full(old)) = self.back.push(old) {
                std::mem::forget(old);
            }
            is_other = true;
        }
        is_other
    }
}
