//! What the host says: HELLO until it is answered, and FORCE no faster than line and device take it.

use glam::DVec3;

use crate::device::link::codec::{MAX_FRAME, encode};
use crate::device::link::device::LinkDevice;
use crate::device::link::messages::{
    Answer, FIRST_PROTOCOL, PROTOCOL, answering_payload, force_payload, hello_payload,
};
use crate::device::serial::wire::Opener;
use crate::guardian::Watch;

/// HELLO is repeated this often until it is answered, s.
const HELLO_SECONDS: f64 = 0.05;

/// Ticks in which a device hears zero after its session has ended: as long as a watchdog waits.
pub(super) const FAREWELLS: u32 = 20;

/// Number of the last word, counted from the next FORCE: ahead of all that a tick may still say.
const AHEAD: u16 = 64;

/// A frame after the end of whatever was cut short; its length.
fn encode_after_end(payload: &[u8], message: &mut [u8; 1 + MAX_FRAME]) -> Option<usize> {
    let mut frame = [0; MAX_FRAME];
    let length = encode(payload, &mut frame)?;
    message[1..].copy_from_slice(&frame);
    Some(1 + length)
}

impl<O: Opener> LinkDevice<O> {
    /// Says HELLO, now and then; to a device that may hold a force not before zero.
    pub(super) fn greet(&mut self, now: f64) {
        if now >= self.next_hello && self.farewells < FAREWELLS {
            self.next_hello = now + HELLO_SECONDS;
            self.say_hello();
        }
    }

    pub(super) fn say_hello(&mut self) {
        let said = self.send(&hello_payload(self.protocol));
        self.report.hellos += u64::from(said);
    }

    /// Says a force (N, device axes) if it is time to; letting go is always.
    pub(super) fn say_force(&mut self, force: DVec3, enable: bool) {
        let lets_go = std::mem::replace(&mut self.pushes, enable) && !enable;
        let (now, dt) = (self.now, self.dt);
        let may_send = self.freshness.may_send(enable, now) && !self.doubt.stands();
        let is_due = self.pacing.is_due(now, dt) && may_send;
        if lets_go || is_due {
            if is_due && force == DVec3::ZERO {
                self.check();
            }
            let payload = force_payload(self.sequence, force, enable);
            let said = if lets_go {
                self.send_numbered(&payload, Self::send_at_once)
            } else {
                self.line.queued() == 0 && self.send_numbered(&payload, Self::send)
            };
            if !said {
                self.report.unsent += 1;
                self.refused.get_or_insert(now);
            }
        }
    }

    /// Asks a device of protocol 1 whether it hears, in front of a FORCE that is not felt. Where the line's
    /// speed is known the driver tells what waits, and a slow line has no room for such answers.
    fn check(&mut self) {
        let is_blind = self.line.bits_per_second().is_none();
        if is_blind && self.protocol == FIRST_PROTOCOL && self.doubt.checks(self.now) {
            self.say_hello();
        }
    }

    /// Says zero in spite of everything that waits, and then once more if `again`: one may be lost.
    pub(super) fn say_zero(&mut self, again: bool) -> bool {
        let payload = force_payload(self.sequence, DVec3::ZERO, false);
        let send = if again {
            Self::send
        } else {
            Self::send_at_once
        };
        self.send_numbered(&payload, send)
    }

    /// Tells that the servo lives, and the zero to be said should it end.
    pub(super) fn live(&mut self) -> Watch {
        let mut frame = [0; 1 + MAX_FRAME];
        let mut length = 0;
        if self.is_greeted() || self.farewells > 0 {
            let sequence = self.sequence.wrapping_add(AHEAD);
            let zero = force_payload(sequence, DVec3::ZERO, false);
            let said = if self.protocol == PROTOCOL {
                encode_after_end(&answering_payload(zero, &self.answer()), &mut frame)
            } else {
                encode_after_end(&zero, &mut frame)
            };
            length = said.unwrap_or(0);
        }
        let watch = self.line.live(&frame[..length]);
        if watch == Watch::Spoke {
            // Its number is used up.
            self.sequence = self.sequence.wrapping_add(AHEAD + 1);
            self.freshness.forget();
        }
        watch
    }

    /// Zero to a device whose session has ended, for some ticks: it may hold a force of that.
    pub(super) fn say_farewell(&mut self) {
        let is_first = self.farewells == FAREWELLS;
        if self.farewells > 0 && (is_first || self.is_free()) {
            self.say_zero(!is_first);
        }
        self.farewells = self.farewells.saturating_sub(1);
    }

    /// Whether a message would leave at once instead of waiting behind another one.
    fn is_free(&mut self) -> bool {
        self.pacing.has_carried(self.now, self.dt) && self.line.queued() == 0
    }

    /// A FORCE in the layout of this session; true when it has left.
    fn send_numbered(
        &mut self,
        payload: &[u8; 10],
        send: impl FnOnce(&mut Self, &[u8]) -> bool,
    ) -> bool {
        let said = if self.protocol == PROTOCOL {
            let answering = answering_payload(*payload, &self.answer());
            send(self, &answering)
        } else {
            send(self, payload)
        };
        if said {
            if self.protocol == PROTOCOL {
                self.freshness.send(self.sequence, self.now);
            }
            self.sequence = self.sequence.wrapping_add(1);
            self.report.forces += 1;
            self.pacing.send(self.now);
            self.refused = None;
        }
        said
    }

    fn answer(&self) -> Answer {
        let damping = self.greeting.filter(|_| self.brakes);
        Answer {
            time_us: self.newest.map_or(0, |newest| newest.state.time_us),
            age: self.now - self.heard,
            damping: damping.map_or(0.0, |greeting| f64::from(greeting.largest_damping)),
        }
    }

    /// Puts a frame on the line; false when it does not fit or the line is gone.
    fn send(&mut self, payload: &[u8]) -> bool {
        let mut frame = [0; MAX_FRAME];
        let length = encode(payload, &mut frame);
        let sent = length.is_some_and(|length| self.line.send(&frame[..length]));
        if sent {
            self.carry(length.unwrap_or(0));
        }
        sent
    }

    /// Says it in spite of all that may still wait, which is thrown away where it can be.
    fn send_at_once(&mut self, payload: &[u8]) -> bool {
        if self.line.queued() == 0 && self.refused.is_none() {
            return self.send(payload);
        }
        let mut frame = [0; MAX_FRAME];
        let Some(length) = encode(payload, &mut frame) else {
            return false;
        };
        self.line.send_at_once(&frame[..length]);
        self.carry(length);
        true
    }

    fn carry(&mut self, bytes: usize) {
        let speed = self.line.bits_per_second();
        self.pacing.carry(bytes, speed, self.now, self.dt);
    }
}
