//! A port that may be unplugged and come back, with the bytes not sent yet. Never waits.

use std::io::ErrorKind;
use std::task::Poll;

use crate::device::serial::wire::{Opener, Wire};
use crate::guardian::Watch;

/// A port that is gone is tried again this often, s.
const REOPEN_SECONDS: f64 = 0.2;
/// Longest message and the byte that ends the one before it, bytes.
const OUTBOX: usize = 64;
/// Ends whatever was cut short, in each of the protocols that have ends.
const END: u8 = 0;

/// A line to a device.
#[derive(Debug)]
pub struct Line<O: Opener> {
    opener: O,
    wire: Option<O::Wire>,
    /// Not closed yet: that may take its time, and is left to the opener.
    gone: Option<O::Wire>,
    /// The opener owes an answer.
    is_asked: bool,
    retry_at: f64,
    pending: [u8; OUTBOX],
    pending_from: usize,
    pending_to: usize,
    /// Said at once, and again when what waited with it has been thrown away.
    urgent: [u8; OUTBOX],
    urgent_to: usize,
}

impl<O: Opener> Line<O> {
    /// Opens the line.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn open(mut opener: O) -> std::io::Result<Self> {
        let wire = opener.open()?;
        Ok(Self {
            opener,
            wire: Some(wire),
            gone: None,
            is_asked: false,
            retry_at: 0.0,
            pending: [0; OUTBOX],
            pending_from: 0,
            pending_to: 0,
            urgent: [0; OUTBOX],
            urgent_to: 0,
        })
    }

    /// Whether there is a port.
    pub fn is_open(&self) -> bool {
        self.wire.is_some()
    }

    /// Leaves a port that is gone, until `now` has gone on a while.
    pub fn close(&mut self, now: f64) {
        self.gone = self.wire.take();
        self.retry_at = now + REOPEN_SECONDS;
        (self.pending_from, self.pending_to) = (0, 0);
        self.urgent_to = 0;
    }

    /// Leaves the port for good, when no tick comes any more: closing may take its time. A device that
    /// was not let go is left to its guardian.
    pub fn end(&mut self, was_let_go: bool) {
        if let Some(wire) = self.wire.as_mut().filter(|_| was_let_go) {
            wire.dismiss();
        }
        self.close(f64::INFINITY);
        self.gone = None;
    }

    /// Asks for the port again now and then; true when it is back.
    pub fn reopen(&mut self, now: f64) -> bool {
        if !self.is_asked {
            if now < self.retry_at {
                return false;
            }
            self.opener.ask(self.gone.take());
            self.is_asked = true;
        }
        let Poll::Ready(wire) = self.opener.answer() else {
            return false;
        };
        self.wire = wire;
        self.is_asked = false;
        self.retry_at = now + REOPEN_SECONDS;
        self.is_open()
    }

    /// The next bytes that have come, as many as fit; None when the line is gone.
    pub fn read(&mut self, buffer: &mut [u8]) -> Option<usize> {
        let wire = self.wire.as_mut()?;
        let length = wire.waiting().ok()?.min(buffer.len());
        if length == 0 {
            return Some(0);
        }
        match wire.read(&mut buffer[..length]) {
            Ok(0) => None,
            Ok(length) => Some(length),
            Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => Some(0),
            Err(_) => None,
        }
    }

    /// Bytes of messages that have not left this computer, as far as the driver tells.
    pub fn queued(&mut self) -> usize {
        let wire = self.wire.as_mut().map_or(0, Wire::queued);
        self.pending_to - self.pending_from + wire
    }

    /// Whether somebody says the last word should this process end.
    pub fn is_guarded(&self) -> bool {
        self.wire.as_ref().is_some_and(Wire::is_guarded)
    }

    /// Says that the servo lives, and what is to be said should it end. If that was said since the last
    /// time, all that waited before it is gone.
    pub fn live(&mut self, last_word: &[u8]) -> Watch {
        let watch = (self.wire.as_mut()).map_or(Watch::Kept, |wire| wire.live(last_word));
        if watch == Watch::Spoke {
            (self.pending_from, self.pending_to) = (0, 0);
            self.urgent_to = 0;
        }
        watch
    }

    /// Bits that the line takes a second, where that is known.
    pub fn bits_per_second(&self) -> Option<u32> {
        self.wire.as_ref().and_then(Wire::bits_per_second)
    }

    /// Puts a message on the line; false when it is longer than any may be, when it does not fit now,
    /// or when the line is gone.
    pub fn send(&mut self, message: &[u8]) -> bool {
        self.flush();
        if self.wire.is_none() || self.pending_from < self.pending_to {
            return false;
        }
        let Some(pending) = self.pending.get_mut(..message.len()) else {
            return false;
        };
        pending.copy_from_slice(message);
        (self.pending_from, self.pending_to) = (0, message.len());
        self.flush();
        if self.pending_from == 0 && self.pending_to > 0 {
            // Not begun: better a newer message later than this one.
            self.pending_to = 0;
            return false;
        }
        true
    }

    /// Says this instead of what has not left: now, or before all that comes later. What waits is thrown
    /// away by the driver when it gets to it; then this is said once more.
    pub fn send_at_once(&mut self, message: &[u8]) {
        let Some(wire) = &mut self.wire else { return };
        let Some(urgent) = self.urgent.get_mut(1..=message.len()) else {
            return;
        };
        urgent.copy_from_slice(message);
        // Where the driver cuts is not known.
        self.urgent[0] = END;
        self.urgent_to = 1 + message.len();
        wire.discard();
        self.say_urgent();
    }

    fn say_urgent(&mut self) {
        self.pending = self.urgent;
        (self.pending_from, self.pending_to) = (0, self.urgent_to);
        self.flush();
    }

    /// Says again what was urgent, if it may have been thrown away with all else.
    pub fn repeat(&mut self) {
        if self.wire.as_mut().is_some_and(Wire::has_discarded) && self.urgent_to > 0 {
            self.say_urgent();
            self.urgent_to = 0;
        }
    }

    /// Sends the rest of a message that did not fit.
    pub fn flush(&mut self) {
        while self.pending_from < self.pending_to {
            let Some(wire) = &mut self.wire else { return };
            match wire.write(&self.pending[self.pending_from..self.pending_to]) {
                Ok(written) if written > 0 => self.pending_from += written,
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                // A line that is gone is found by the next read.
                _ => return,
            }
        }
        (self.pending_from, self.pending_to) = (0, 0);
    }
}
