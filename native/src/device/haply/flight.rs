//! Requests that have no answer yet, and the times between which an answer was measured.

/// Requests that may wait for their answers at once; more would only queue on the way.
const MOST: usize = 4;
/// For a request that has waited for longer no other is kept back, s.
const PATIENCE_SECONDS: f64 = 0.005;
/// An answer that takes longer will not come, s: a line that hands over what it has every 16 ms is no
/// loss.
const LOST_SECONDS: f64 = 0.02;
/// More are not sent in that time.
const REMEMBERED: usize = 32;

/// When the angles of an answer were measured: between these times, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// The request left.
    pub asked: f64,
    /// The answer was read.
    pub came: f64,
}

/// Times at which unanswered requests were sent, oldest first.
#[derive(Debug, Clone, Copy)]
pub struct Flight {
    sent: [f64; REMEMBERED],
    count: usize,
    /// The last answer, s.
    answered: f64,
}

impl Default for Flight {
    fn default() -> Self {
        Self {
            sent: [0.0; REMEMBERED],
            count: 0,
            answered: f64::NEG_INFINITY,
        }
    }
}

impl Flight {
    /// Whether another request at `now` (s) would have to queue.
    pub fn is_full(&self, now: f64) -> bool {
        let sent = self.sent[..self.count].iter();
        sent.filter(|sent| now - **sent <= PATIENCE_SECONDS).count() >= MOST
    }

    /// A request leaves at `now`, s; the oldest is forgotten when there are too many.
    pub fn send(&mut self, now: f64) {
        if self.count == REMEMBERED {
            self.forget_oldest();
        }
        self.sent[self.count] = now;
        self.count += 1;
    }

    /// When an answer that is read at `now` (s) was measured. Boards answer in turn, so it is that to the
    /// oldest request; one that nobody asked for was measured when it came.
    pub fn moment(&self, now: f64) -> Moment {
        let asked = if self.count > 0 { self.sent[0] } else { now };
        Moment { asked, came: now }
    }

    /// The oldest request was answered at `now`, s.
    pub fn answer(&mut self, now: f64) {
        self.answered = now;
        self.forget_oldest();
    }

    /// All that had come at `now` (s) was read: gives up requests without an answer; how many. When
    /// newer ones are answered, an older one will not be.
    pub fn expire(&mut self, now: f64) -> u64 {
        let is_moving = self.answered == now;
        let longest = if is_moving {
            PATIENCE_SECONDS
        } else {
            LOST_SECONDS
        };
        let mut expired = 0;
        while self.count > 0 && now - self.sent[0] > longest {
            self.forget_oldest();
            expired += 1;
        }
        expired
    }

    fn forget_oldest(&mut self) {
        if self.count > 0 {
            self.sent.copy_within(1..self.count, 0);
            self.count -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_that_come_together_were_asked_for_one_after_the_other() {
        let mut flight = Flight::default();
        let mut asked = Vec::new();
        // 1 kHz; the line hands over what it has after 16 ms.
        for tick in 0..16 {
            let now = f64::from(tick) * 1e-3;
            assert_eq!(flight.expire(now), 0);
            if !flight.is_full(now) {
                flight.send(now);
                asked.push(now);
            }
        }
        assert!(asked.len() > 8, "{asked:?}");
        for asked in asked {
            assert_eq!(flight.moment(0.016), Moment { asked, came: 0.016 });
            flight.answer(0.016);
        }
        assert_eq!(flight.moment(0.016).asked, 0.016, "nobody asked");
    }

    #[test]
    fn a_lost_answer_is_given_up_when_later_ones_come_or_none_does() {
        for (later, given_up) in [(Some(0.004), 0.0051), (None, 0.0201)] {
            let mut flight = Flight::default();
            flight.send(0.0);
            flight.send(given_up - 1e-3);
            for tick in 1..40 {
                let now = f64::from(tick) * 1e-3;
                if later.is_some() && now >= given_up {
                    flight.answer(now);
                    flight.send(now);
                }
                let lost = flight.expire(now);
                assert!(lost == 0 || now > given_up, "{now}");
            }
        }
    }
}
