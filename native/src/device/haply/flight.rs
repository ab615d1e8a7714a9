//! Requests that have no answer yet.

/// Requests that may wait for their answers at once; more would only queue on the way.
const MOST: usize = 4;
/// An answer that takes longer will not come, s.
const PATIENCE_SECONDS: f64 = 0.005;

/// Times at which unanswered requests were sent, oldest first.
#[derive(Debug, Clone, Copy, Default)]
pub struct Flight {
    sent: [f64; MOST],
    count: usize,
}

impl Flight {
    /// Whether another request would have to queue.
    pub fn is_full(&self) -> bool {
        self.count == MOST
    }

    /// A request leaves at `now`, s; when full, the oldest is given up.
    pub fn send(&mut self, now: f64) {
        if self.is_full() {
            self.answer();
        }
        self.sent[self.count] = now;
        self.count += 1;
    }

    /// The oldest request is answered.
    pub fn answer(&mut self) {
        if self.count > 0 {
            self.sent.copy_within(1..self.count, 0);
            self.count -= 1;
        }
    }

    /// Gives up requests that have waited for too long; how many.
    pub fn expire(&mut self, now: f64) -> u64 {
        let mut expired = 0;
        while self.count > 0 && now - self.sent[0] > PATIENCE_SECONDS {
            self.answer();
            expired += 1;
        }
        expired
    }
}
