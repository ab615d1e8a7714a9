//! An open port for a thread besides the tick's, for what may wait.

use std::io;

#[cfg(windows)]
use serialport::COMPort as Port;
#[cfg(unix)]
use serialport::TTYPort as Port;
use serialport::{ClearBuffer, SerialPort};

use crate::guardian::Guardian;

/// The port once more.
#[derive(Debug)]
pub struct Twin(Port);

impl Twin {
    pub(super) fn of(port: Port) -> Self {
        Self(port)
    }

    /// Throws away what has not left. A port that is gone has nothing that waits, and its next use tells.
    pub fn discard(&self) {
        let _ = self.0.clear(ClearBuffer::Output);
    }

    /// Starts a guardian for this port. Takes some milliseconds.
    ///
    /// # Errors
    /// When the system does not let it run.
    pub fn guardian(&self) -> io::Result<Guardian> {
        Guardian::of(&self.0)
    }
}
