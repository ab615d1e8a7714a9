//! A simulated device of this computer behind a TCP socket: what a pseudo-terminal is where there are none.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use crate::device::serial::twin::Twin;
use crate::device::serial::wire::{TwinnedWire, Wire};

/// How the name of such a port begins; address and number follow.
pub const SCHEME: &str = "socket://";
/// Longest wait for a device that is there.
const CONNECT: Duration = Duration::from_secs(2);
/// A device that has another host hangs up at once; this is many of its periods.
const HANGS_UP_WITHIN: Duration = Duration::from_millis(50);
/// As many bytes as are seen before they are read; several ticks' worth.
const SEEN: usize = 512;

/// A connection, read and written without waiting.
#[derive(Debug)]
pub struct SocketWire {
    stream: TcpStream,
    baud: Option<u32>,
}

impl SocketWire {
    /// Connects to a device at an address of this computer, such as `127.0.0.1:4000`.
    ///
    /// # Errors
    /// When it is no such address, nothing listens there, or the device has another host.
    pub(super) fn open(address: &str, baud: Option<u32>) -> io::Result<Self> {
        let address = (address.parse::<SocketAddr>().ok())
            .filter(|address| address.ip().is_loopback())
            .ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "not of this computer"))?;
        let stream = TcpStream::connect_timeout(&address, CONNECT)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(HANGS_UP_WITHIN))?;
        if matches!(stream.peek(&mut [0]), Ok(0)) {
            return Err(ErrorKind::ResourceBusy.into());
        }
        stream.set_nonblocking(true)?;
        Ok(Self { stream, baud })
    }
}

impl TwinnedWire for SocketWire {
    fn twin(&self) -> io::Result<Twin> {
        Ok(Twin::Socket(self.stream.try_clone()?))
    }
}

impl Wire for SocketWire {
    fn waiting(&mut self) -> io::Result<usize> {
        match self.stream.peek(&mut [0; SEEN]) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Err(e) if e.kind() == ErrorKind::WouldBlock => Ok(0),
            seen => seen,
        }
    }

    fn bits_per_second(&self) -> Option<u32> {
        self.baud
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.read(buffer)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(bytes)
    }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;
    use std::time::Instant;

    use super::*;

    /// A device's end and the host's.
    fn connected() -> (TcpStream, SocketWire) {
        let device = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = device.local_addr().expect("an address").to_string();
        let wire = SocketWire::open(&address, None).expect("the device listens");
        let (stream, _) = device.accept().expect("the host has connected");
        (stream, wire)
    }

    fn soon<T>(mut what: impl FnMut() -> Option<T>) -> T {
        let start = Instant::now();
        loop {
            if let Some(found) = what() {
                return found;
            }
            assert!(start.elapsed() < Duration::from_secs(20), "it never comes");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn bytes_go_both_ways_and_nothing_is_nothing() {
        let (mut device, mut wire) = connected();
        assert_eq!(wire.waiting().expect("it is there"), 0);
        let mut buffer = [0; 8];
        let none = wire.read(&mut buffer).expect_err("nothing was sent");
        assert_eq!(none.kind(), ErrorKind::WouldBlock);
        device.write_all(b"state").expect("the host is there");
        soon(|| (wire.waiting().expect("it is there") == 5).then_some(()));
        assert_eq!(wire.read(&mut buffer[..5]).expect("five bytes"), 5);
        assert_eq!(&buffer[..5], b"state");
        assert_eq!(wire.write(b"force").expect("room"), 5);
        device.read_exact(&mut buffer[..5]).expect("five bytes");
        assert_eq!(&buffer[..5], b"force");
    }

    #[test]
    fn a_device_that_hangs_up_is_gone() {
        let (device, mut wire) = connected();
        drop(device);
        soon(|| wire.waiting().err());
    }

    #[test]
    fn a_device_that_reads_nothing_takes_nothing_in_the_end() {
        let (_device, mut wire) = connected();
        let full = soon(|| wire.write(&[7; 1 << 16]).err());
        assert_eq!(full.kind(), ErrorKind::WouldBlock);
    }

    #[test]
    fn what_is_no_device_of_this_computer_is_refused() {
        let refused = |address: &str| SocketWire::open(address, None).expect_err("refused").kind();
        for elsewhere in ["192.0.2.1:4000", "localhost:4000", "127.0.0.1", ""] {
            assert_eq!(refused(elsewhere), ErrorKind::InvalidInput, "{elsewhere}");
        }
        let nobody = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = nobody.local_addr().expect("an address").to_string();
        drop(nobody);
        assert_eq!(refused(&address), ErrorKind::ConnectionRefused);
    }

    #[test]
    fn a_device_that_hangs_up_at_once_has_another_host() {
        let device = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = device.local_addr().expect("an address").to_string();
        let hanging_up = std::thread::spawn(move || drop(device.accept()));
        let busy = SocketWire::open(&address, None).expect_err("it has another host");
        assert_eq!(busy.kind(), ErrorKind::ResourceBusy);
        hanging_up.join().expect("it hung up");
    }
}
