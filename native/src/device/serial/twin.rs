//! An open port for a thread besides the tick's, for what may wait.

use std::io;
use std::net::TcpStream;
#[cfg(windows)]
use std::os::windows::io::{AsRawHandle, OwnedHandle as Port};

#[cfg(unix)]
use serialport::{ClearBuffer, SerialPort, TTYPort as Port};
#[cfg(windows)]
use windows_sys::Win32::Devices::Communication::{PURGE_TXABORT, PURGE_TXCLEAR, PurgeComm};

use crate::guardian::Guardian;

/// The port once more.
#[derive(Debug)]
pub enum Twin {
    /// Of a serial port.
    Serial(Port),
    /// Of a simulated device's socket.
    Socket(TcpStream),
}

impl Twin {
    /// Throws away what has not left, and ends a write under way. A port that is gone has nothing that
    /// waits, and its next use tells; what a socket was given has left.
    pub fn discard(&self) {
        match self {
            #[cfg(unix)]
            Self::Serial(port) => {
                let _ = port.clear(ClearBuffer::Output);
            }
            #[cfg(windows)]
            Self::Serial(port) => {
                // SAFETY: the port is open; the call touches no memory.
                let _ = unsafe { PurgeComm(port.as_raw_handle(), PURGE_TXABORT | PURGE_TXCLEAR) };
            }
            Self::Socket(_) => {}
        }
    }

    /// Starts a guardian for this port. Takes some milliseconds.
    ///
    /// # Errors
    /// When the system does not let it run.
    pub fn guardian(&self) -> io::Result<Guardian> {
        match self {
            Self::Serial(port) => Guardian::of(port),
            Self::Socket(stream) => Guardian::of(stream),
        }
    }
}
