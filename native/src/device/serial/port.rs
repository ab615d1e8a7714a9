//! A serial port that never blocks: it reads what is there and writes what fits.

use std::io;
use std::time::Duration;

/// An open line to a device.
pub trait Wire: Send {
    /// Takes what has arrived. `WouldBlock` when nothing has; zero bytes or any other error mean
    /// that the line is gone.
    ///
    /// # Errors
    /// See above; must not allocate for `WouldBlock`.
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize>;
    /// Sends as much as fits at once.
    ///
    /// # Errors
    /// `WouldBlock` when nothing fits; any other error means that the line is gone.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize>;
}

/// Opens a line, at the start and again after unplugging. May take time and memory.
pub trait Opener: Send {
    /// Kind of wire that it opens.
    type Wire: Wire;
    /// Opens the line.
    ///
    /// # Errors
    /// When there is none.
    fn open(&mut self) -> io::Result<Self::Wire>;
}

/// A serial port by name.
#[derive(Debug, Clone)]
pub struct SerialPort {
    /// Path or name for the system.
    pub path: String,
    /// Bits a second; without meaning on USB and pseudo-terminals.
    pub baud: u32,
}

impl Opener for SerialPort {
    type Wire = SerialWire;

    fn open(&mut self) -> io::Result<SerialWire> {
        // Boards with USB of their own send nothing before they see DTR.
        let port = serialport::new(&self.path, self.baud)
            .dtr_on_open(true)
            .timeout(Duration::from_millis(1))
            .open_native()?;
        SerialWire::new(port)
    }
}

#[cfg(unix)]
pub use on_unix::SerialWire;
#[cfg(windows)]
pub use on_windows::SerialWire;

#[cfg(unix)]
mod on_unix {
    use std::io;
    use std::os::fd::AsRawFd;

    use serialport::TTYPort;

    use super::Wire;

    /// A terminal in raw mode, read and written without waiting.
    ///
    /// The calls go around the crate's own `Read` and `Write`: those poll first, and make an error
    /// on the heap whenever nothing has arrived.
    #[derive(Debug)]
    pub struct SerialWire {
        port: TTYPort,
    }

    impl SerialWire {
        pub(super) fn new(port: TTYPort) -> io::Result<Self> {
            let fd = port.as_raw_fd();
            // SAFETY: the descriptor is open while `port` lives; these calls touch no memory.
            let done = unsafe {
                let flags = libc::fcntl(fd, libc::F_GETFL);
                flags >= 0 && libc::fcntl(fd, libc::F_SETFL, flags | libc::O_NONBLOCK) >= 0
            };
            if done {
                shorten_latency(fd);
                Ok(Self { port })
            } else {
                Err(io::Error::last_os_error())
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

    impl Drop for SerialWire {
        /// Gives the terminal back: its exclusive mode outlasts this descriptor for as long as
        /// somebody else, such as a device behind a pseudo-terminal, keeps it open.
        fn drop(&mut self) {
            // SAFETY: the descriptor is open until `port` is dropped after this.
            // An unplugged terminal has no mode to give back, so a failure means nothing.
            // The request's type differs between systems, hence the cast.
            let _ = unsafe { libc::ioctl(self.port.as_raw_fd(), libc::TIOCNXCL as _) };
        }
    }

    fn count(result: isize) -> io::Result<usize> {
        usize::try_from(result).map_err(|_| io::Error::last_os_error())
    }

    impl Wire for SerialWire {
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
}

#[cfg(windows)]
mod on_windows {
    use std::io::{self, Read, Write};

    use serialport::{COMPort, SerialPort};

    use super::Wire;

    /// A COM port, asked first how much has arrived.
    #[derive(Debug)]
    pub struct SerialWire {
        port: COMPort,
    }

    impl SerialWire {
        pub(super) fn new(port: COMPort) -> io::Result<Self> {
            Ok(Self { port })
        }
    }

    impl Wire for SerialWire {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let waiting = self.port.bytes_to_read()? as usize;
            if waiting == 0 {
                return Err(io::ErrorKind::WouldBlock.into());
            }
            let length = waiting.min(buffer.len());
            self.port.read(&mut buffer[..length])
        }

        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            match self.port.write(bytes) {
                Err(e) if e.kind() == io::ErrorKind::TimedOut => {
                    Err(io::ErrorKind::WouldBlock.into())
                }
                other => other,
            }
        }
    }
}
