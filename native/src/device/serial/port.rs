//! A serial port that never waits: it reads what is there and writes what fits.

use std::io;
use std::task::Poll;
use std::time::Duration;

use crate::device::serial::wired::is_wired;
use crate::guardian::Watch;

/// An open line to a device. Nothing here may wait or, while the line is there, allocate.
pub trait Wire: Send {
    /// Bytes that have arrived.
    ///
    /// # Errors
    /// When the line is gone.
    fn waiting(&mut self) -> io::Result<usize>;
    /// Takes as many bytes as the buffer holds, which is no more than are [`waiting`](Self::waiting):
    /// asked for more than there are, a system may wait for somebody who is to bring them, however
    /// it was told not to.
    ///
    /// # Errors
    /// `WouldBlock` when there is nothing after all; zero bytes or any other error mean that the line
    /// is gone.
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize>;
    /// Sends as much as fits at once.
    ///
    /// # Errors
    /// `WouldBlock` when nothing fits; any other error means that the line is gone.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize>;
    /// Bytes written that have not left this computer, as far as the driver tells.
    fn queued(&mut self) -> usize {
        0
    }
    /// Has these thrown away, where the driver can; does not wait for it.
    fn discard(&mut self) {}
    /// Whether that was done behind the caller's back, since the last call of this: what was written
    /// meanwhile may be gone too.
    fn has_discarded(&mut self) -> bool {
        false
    }
    /// Bits that the line takes a second, where that is known and its own.
    fn bits_per_second(&self) -> Option<u32> {
        None
    }
    /// Whether somebody says the last word should this process end.
    fn is_guarded(&self) -> bool {
        false
    }
    /// Says that the servo lives, and what is to be said should it end.
    fn live(&mut self, _last_word: &[u8]) -> Watch {
        Watch::Kept
    }
}

/// Opens a line, at the start and again after unplugging.
pub trait Opener: Send {
    /// Kind of wire that it opens.
    type Wire: Wire;
    /// Opens the line, which may take time and memory: outside of the tick only.
    ///
    /// # Errors
    /// When there is none.
    fn open(&mut self) -> io::Result<Self::Wire>;
    /// Asks for the line again, and gives back the one that is gone. Does not wait.
    ///
    /// Here and in [`answer`](Self::answer) as is right for a line in memory, which opens at once.
    fn ask(&mut self, gone: Option<Self::Wire>) {
        drop(gone);
    }
    /// What came of it, once for each time that it was asked; None when there is no line. Does not
    /// wait.
    fn answer(&mut self) -> Poll<Option<Self::Wire>> {
        Poll::Ready(self.open().ok())
    }
}

/// A serial port by name. [`Reopening`](super::reopening::Reopening) opens it again.
#[derive(Debug, Clone)]
pub struct SerialPort {
    /// Path or name for the system.
    pub path: String,
    /// Bits a second, if somebody has said so; without meaning on USB and pseudo-terminals.
    pub baud: Option<u32>,
}

/// Speed of a port whose speed nobody has said, bits a second.
const USUAL_BAUD: u32 = 115_200;

impl SerialPort {
    /// Opens the port. May take seconds: a driver waits for what it likes.
    ///
    /// # Errors
    /// When there is none, or somebody else has it.
    pub fn open(&self) -> io::Result<SerialWire> {
        let baud = self.baud.unwrap_or(USUAL_BAUD);
        // Boards with USB of their own send nothing before they see DTR.
        let port = serialport::new(&self.path, baud)
            .dtr_on_open(true)
            .timeout(Duration::from_millis(1))
            .open_native()?;
        let is_its_own = self.baud.is_some() || is_wired(&self.path);
        SerialWire::new(port, is_its_own.then_some(baud))
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
    use crate::device::serial::twin::Twin;

    /// A terminal in raw mode, read and written without waiting.
    ///
    /// The calls go around the crate's own `Read` and `Write`: those poll first, and make an error
    /// on the heap whenever nothing has arrived.
    #[derive(Debug)]
    pub struct SerialWire {
        port: TTYPort,
        baud: Option<u32>,
    }

    impl SerialWire {
        pub(super) fn new(port: TTYPort, baud: Option<u32>) -> io::Result<Self> {
            let fd = port.as_raw_fd();
            // SAFETY: the descriptor is open while `port` lives; these calls touch no memory.
            let done = unsafe {
                let flags = libc::fcntl(fd, libc::F_GETFL);
                flags >= 0 && libc::fcntl(fd, libc::F_SETFL, flags | libc::O_NONBLOCK) >= 0
            };
            if done {
                shorten_latency(fd);
                Ok(Self { port, baud })
            } else {
                Err(io::Error::last_os_error())
            }
        }

        pub(in crate::device::serial) fn twin(&self) -> io::Result<Twin> {
            Ok(Twin::of(self.port.try_clone_native()?))
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
}

#[cfg(windows)]
mod on_windows {
    use std::io::{self, Read, Write};

    use serialport::{COMPort, SerialPort};

    use super::Wire;
    use crate::device::serial::twin::Twin;

    /// A COM port.
    #[derive(Debug)]
    pub struct SerialWire {
        port: COMPort,
        baud: Option<u32>,
    }

    impl SerialWire {
        pub(super) fn new(port: COMPort, baud: Option<u32>) -> io::Result<Self> {
            Ok(Self { port, baud })
        }

        pub(in crate::device::serial) fn twin(&self) -> io::Result<Twin> {
            Ok(Twin::of(self.port.try_clone_native()?))
        }
    }

    impl Wire for SerialWire {
        fn waiting(&mut self) -> io::Result<usize> {
            Ok(self.port.bytes_to_read()? as usize)
        }

        fn queued(&mut self) -> usize {
            self.port.bytes_to_write().map_or(0, |bytes| bytes as usize)
        }

        fn bits_per_second(&self) -> Option<u32> {
            self.baud
        }

        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.port.read(buffer)
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
