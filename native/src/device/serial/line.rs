//! A port that may be unplugged and come back, with the bytes not sent yet. Never blocks.

use std::io::ErrorKind;

use crate::device::serial::port::{Opener, Wire};

/// A port that is gone is tried again this often, s.
const REOPEN_SECONDS: f64 = 0.2;
/// Longest message, bytes.
const OUTBOX: usize = 64;

/// A line to a device.
#[derive(Debug)]
pub struct Line<O: Opener> {
    opener: O,
    wire: Option<O::Wire>,
    retry_at: f64,
    pending: [u8; OUTBOX],
    pending_from: usize,
    pending_to: usize,
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
            retry_at: 0.0,
            pending: [0; OUTBOX],
            pending_from: 0,
            pending_to: 0,
        })
    }

    /// Whether there is a port.
    pub fn is_open(&self) -> bool {
        self.wire.is_some()
    }

    /// Leaves the port, until `now` has gone on a while.
    pub fn close(&mut self, now: f64) {
        self.wire = None;
        self.retry_at = now + REOPEN_SECONDS;
        (self.pending_from, self.pending_to) = (0, 0);
    }

    /// Tries the port again now and then; true when it is back. Opening takes time and memory:
    /// nothing is in contact.
    pub fn reopen(&mut self, now: f64) -> bool {
        if now < self.retry_at {
            return false;
        }
        self.wire = self.opener.open().ok();
        self.retry_at = now + REOPEN_SECONDS;
        self.is_open()
    }

    /// The next bytes that have come, as many as fit; None when the line is gone.
    pub fn read(&mut self, buffer: &mut [u8]) -> Option<usize> {
        match self.wire.as_mut()?.read(buffer) {
            Ok(0) => None,
            Ok(length) => Some(length),
            Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => Some(0),
            Err(_) => None,
        }
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
