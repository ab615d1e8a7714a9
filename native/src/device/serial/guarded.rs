//! A serial port with its guardian.

use std::io;

use crate::device::serial::port::{SerialPort, SerialWire, Wire};
use crate::guardian::Guardian;

/// A serial port, and whether its device keeps its force when nobody speaks to it any more.
#[derive(Debug, Clone)]
pub struct GuardedPort {
    /// The port.
    pub port: SerialPort,
    /// It is not opened without a guardian.
    pub needs_guardian: bool,
}

impl GuardedPort {
    /// Opens the port and starts the guardian. May take seconds.
    ///
    /// # Errors
    /// When there is no port, or somebody else has it, or it needs a guardian and there is none.
    pub fn open(&self) -> io::Result<GuardedWire> {
        let wire = self.port.open()?;
        let guardian = match wire.guardian() {
            Err(error) if self.needs_guardian => return Err(error),
            guardian => guardian.ok(),
        };
        Ok(GuardedWire { guardian, wire })
    }
}

/// An open port, watched if that can be.
#[derive(Debug)]
pub struct GuardedWire {
    /// Before the wire: it is dismissed first.
    guardian: Option<Guardian>,
    wire: SerialWire,
}

impl Wire for GuardedWire {
    fn waiting(&mut self) -> io::Result<usize> {
        self.wire.waiting()
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.wire.read(buffer)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.wire.write(bytes)
    }

    fn queued(&mut self) -> usize {
        self.wire.queued()
    }

    fn discard(&mut self) {
        self.wire.discard();
    }

    fn bits_per_second(&self) -> Option<u32> {
        self.wire.bits_per_second()
    }

    fn is_guarded(&self) -> bool {
        self.guardian.is_some()
    }

    fn live(&mut self, last_word: &[u8]) -> bool {
        let guardian = self.guardian.as_ref();
        guardian.is_none_or(|guardian| guardian.live(last_word))
    }
}
