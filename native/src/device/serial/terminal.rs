//! A serial port of Linux and macOS: a terminal.

use std::io;
use std::os::fd::AsRawFd;

use serialport::TTYPort;

use crate::device::serial::twin::Twin;
use crate::device::serial::wire::{TwinnedWire, Wire};

/// A terminal in raw mode, read and written without waiting.
///
/// The calls go around the crate's own `Read` and `Write`: those poll first, and make an error
/// on the heap whenever nothing has arrived.
#[derive(Debug)]
pub struct Terminal {
    port: TTYPort,
    baud: Option<u32>,
}

impl Terminal {
    pub(super) fn open(path: &str, baud: u32, is_its_own: bool) -> io::Result<Self> {
        // Boards with USB of their own send nothing before they see DTR.
        let port = serialport::new(path, baud)
            .dtr_on_open(true)
            .open_native()?;
        let fd = port.as_raw_fd();
        // SAFETY: the descriptor is open while `port` lives; these calls touch no memory.
        let done = unsafe {
            let flags = libc::fcntl(fd, libc::F_GETFL);
            flags >= 0 && libc::fcntl(fd, libc::F_SETFL, flags | libc::O_NONBLOCK) >= 0
        };
        if !done {
            return Err(io::Error::last_os_error());
        }
        shorten_latency(fd);
        Ok(Self {
            port,
            baud: is_its_own.then_some(baud),
        })
    }

    /// A number of bytes that the terminal tells.
    #[allow(clippy::useless_conversion)] // The request's type differs between systems.
    fn told(&self, request: libc::c_ulong) -> io::Result<usize> {
        let mut bytes: libc::c_int = 0;
        // SAFETY: the descriptor is open, and both requests write one integer.
        match unsafe { libc::ioctl(self.port.as_raw_fd(), request as _, &raw mut bytes) } {
            0 => Ok(usize::try_from(bytes).unwrap_or(0)),
            _ => Err(io::Error::last_os_error()),
        }
    }
}

/// Asks the driver to hand bytes over at once, which any user may do: an FTDI adapter's latency
/// timer goes from 16 to 1 ms. Here, as a port that is plugged in again starts with its default.
#[cfg(target_os = "linux")]
fn shorten_latency(fd: std::os::fd::RawFd) {
    /// `ASYNC_LOW_LATENCY` of linux/tty_flags.h.
    const LOW_LATENCY: i32 = 1 << 13;
    /// Place of `flags` in linux/serial.h's `struct serial_struct`, of 18 words at most.
    const FLAGS: usize = 4;
    let mut serial = [0_i32; 32];
    // SAFETY: the descriptor is open and the buffer larger than what the kernel writes or reads.
    // What knows no such mode, such as a pseudo-terminal, says so and stays as it is; whether
    // bytes are held back nevertheless is seen in how STATE arrives.
    unsafe {
        if libc::ioctl(fd, libc::TIOCGSERIAL as _, serial.as_mut_ptr()) == 0 {
            serial[FLAGS] |= LOW_LATENCY;
            let _ = libc::ioctl(fd, libc::TIOCSSERIAL as _, serial.as_ptr());
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn shorten_latency(_fd: std::os::fd::RawFd) {}

impl Drop for Terminal {
    /// Gives the terminal back: its exclusive mode outlasts this descriptor for as long as
    /// somebody else, such as a device behind a pseudo-terminal, keeps it open; its lock, as long as
    /// a twin on another thread does.
    fn drop(&mut self) {
        let fd = self.port.as_raw_fd();
        // SAFETY: the descriptor is open until `port` is dropped after this.
        // An unplugged terminal has nothing to give back, so a failure means nothing.
        // The request's type differs between systems, hence the cast.
        let _ = unsafe {
            (
                libc::ioctl(fd, libc::TIOCNXCL as _),
                libc::flock(fd, libc::LOCK_UN),
            )
        };
    }
}

fn count(result: isize) -> io::Result<usize> {
    usize::try_from(result).map_err(|_| io::Error::last_os_error())
}

impl TwinnedWire for Terminal {
    fn twin(&self) -> io::Result<Twin> {
        Ok(Twin::Serial(self.port.try_clone_native()?))
    }
}

impl Wire for Terminal {
    /// Linux' terminals wait in `read` and `poll` for a worker of the kernel whenever they are
    /// empty, and a worker gets its turn when busy processes let it: this asks without. A terminal
    /// that has hung up answers EIO.
    fn waiting(&mut self) -> io::Result<usize> {
        self.told(libc::FIONREAD as _)
    }

    fn queued(&mut self) -> usize {
        // What knows no queue has none that could be thrown away.
        self.told(libc::TIOCOUTQ as _).unwrap_or(0)
    }

    fn bits_per_second(&self) -> Option<u32> {
        self.baud
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        // SAFETY: the buffer is valid for writing its length; the descriptor is open.
        count(unsafe {
            libc::read(
                self.port.as_raw_fd(),
                buffer.as_mut_ptr().cast(),
                buffer.len(),
            )
        })
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // SAFETY: the bytes are valid for reading; the descriptor is open.
        count(unsafe { libc::write(self.port.as_raw_fd(), bytes.as_ptr().cast(), bytes.len()) })
    }
}
