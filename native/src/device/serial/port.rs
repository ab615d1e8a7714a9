//! A port by its name for the system.

use std::io;

#[cfg(windows)]
use crate::device::serial::com_port::ComPort as SystemWire;
use crate::device::serial::socket::{SCHEME, SocketWire};
#[cfg(unix)]
use crate::device::serial::terminal::Terminal as SystemWire;
use crate::device::serial::wire::TwinnedWire;

/// A port by name. [`Reopening`](super::reopening::Reopening) opens it again.
#[derive(Debug, Clone)]
pub struct SerialPort {
    /// Path or name for the system, or `socket://127.0.0.1:PORT` for a simulated device of this
    /// computer.
    pub path: String,
    /// Bits a second, if somebody has said so; without meaning on USB, pseudo-terminals and sockets.
    pub baud: Option<u32>,
}

/// Speed of a port whose speed nobody has said, bits a second.
const USUAL_BAUD: u32 = 115_200;

impl SerialPort {
    /// Opens the port. May take seconds: a driver waits for what it likes.
    ///
    /// # Errors
    /// When there is none, or somebody else has it.
    pub fn open(&self) -> io::Result<Box<dyn TwinnedWire>> {
        if let Some(address) = self.path.strip_prefix(SCHEME) {
            return Ok(Box::new(SocketWire::open(address, self.baud)?));
        }
        let is_its_own = self.baud.is_some() || is_wired(&self.path);
        let baud = self.baud.unwrap_or(USUAL_BAUD);
        Ok(Box::new(SystemWire::open(&self.path, baud, is_its_own)?))
    }
}

/// Whether the port of this path is a chip that sends bit by bit, at the speed that it was told.
fn is_wired(path: &str) -> bool {
    // A path may lead to the port by a link with a name that lasts.
    let real = std::fs::canonicalize(path).unwrap_or_else(|_| path.into());
    let name = real.to_string_lossy();
    const CHIPS: [&str; 8] = [
        "/dev/ttyUSB",
        "/dev/ttyS",
        "/dev/ttyAMA",
        "/dev/ttyTHS",
        "/dev/ttymxc",
        "/dev/ttyO",
        "/dev/cu.usbserial",
        "/dev/tty.usbserial",
    ];
    CHIPS.iter().any(|chip| name.starts_with(chip))
}
