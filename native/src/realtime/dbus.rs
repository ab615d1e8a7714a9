//! The little of D-Bus that one question to a system service needs.
//!
//! Written against the D-Bus specification 0.43 rather than taken from a crate: whoever asks here is
//! a thread about to become a servo, so a bus that is silent, slow, closed or hostile must cost a
//! bounded time and a bounded amount of memory, and no thread may stay behind.

use std::io::{self, ErrorKind, Read, Write};
use std::mem::{size_of, zeroed};
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::time::Instant;

/// Longest message that is taken, bytes; answers to our questions are a tenth of this.
const LARGEST_MESSAGE: usize = 16 * 1024;
/// Longest line of the handshake, bytes.
const LONGEST_LINE: usize = 1024;

const METHOD_CALL: u8 = 1;
const METHOD_RETURN: u8 = 2;
const ERROR: u8 = 3;

/// Where a method lives.
#[derive(Debug, Clone, Copy)]
pub struct Method<'a> {
    pub destination: &'a str,
    pub path: &'a str,
    pub interface: &'a str,
    pub member: &'a str,
}

/// An argument of a call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<'a> {
    Text(&'a str),
    Int32(i32),
    Uint32(u32),
    Uint64(u64),
}

/// A connection whose whole life ends at a deadline.
#[derive(Debug)]
pub struct Bus {
    stream: UnixStream,
    deadline: Instant,
    serial: u32,
}

/// What came back from a call.
#[derive(Debug, PartialEq)]
struct Message {
    kind: u8,
    reply_to: u32,
    body: Vec<u8>,
}

fn bad(what: &str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, format!("the bus sent {what}"))
}

impl Bus {
    /// Connects to the first address of a list (`unix:path=...;unix:abstract=...`) that answers.
    pub fn connect(addresses: &str, deadline: Instant) -> io::Result<Self> {
        let mut last = io::Error::new(ErrorKind::Unsupported, "no unix address of a bus is known");
        for address in addresses.split(';').filter_map(socket_name) {
            match open(&address).and_then(|stream| Self::greet(stream, deadline)) {
                Ok(bus) => return Ok(bus),
                Err(error) => last = error,
            }
        }
        Err(last)
    }

    fn greet(stream: UnixStream, deadline: Instant) -> io::Result<Self> {
        let mut bus = Self {
            stream,
            deadline,
            serial: 0,
        };
        // SAFETY: always succeeds, touches no memory.
        let user = unsafe { libc::geteuid() }.to_string();
        let hex: String = user.bytes().map(|b| format!("{b:02x}")).collect();
        bus.send(format!("\0AUTH EXTERNAL {hex}\r\n").as_bytes())?;
        if !bus.line()?.starts_with(b"OK") {
            return Err(bad("a refusal of this user"));
        }
        bus.send(b"BEGIN\r\n")?;
        let hello = Method {
            destination: "org.freedesktop.DBus",
            path: "/org/freedesktop/DBus",
            interface: "org.freedesktop.DBus",
            member: "Hello",
        };
        bus.call(&hello, &[])?;
        Ok(bus)
    }

    /// Calls a method and gives the body of its answer.
    ///
    /// # Errors
    /// `Other` with the service's own words when it refuses; others when the bus fails.
    pub fn call(&mut self, method: &Method<'_>, arguments: &[Value<'_>]) -> io::Result<Vec<u8>> {
        self.serial += 1;
        self.send(&call_message(self.serial, method, arguments))?;
        loop {
            let message = self.receive()?;
            if message.reply_to != self.serial {
                continue;
            }
            match message.kind {
                METHOD_RETURN => return Ok(message.body),
                ERROR => {
                    let words = Reader::new(&message.body)
                        .text()
                        .unwrap_or("no reason given");
                    return Err(io::Error::other(words.to_owned()));
                }
                _ => {}
            }
        }
    }

    /// Reads a property that is an int32 or an int64.
    pub fn integer(&mut self, owner: &Method<'_>, name: &str) -> io::Result<i64> {
        let get = Method {
            interface: "org.freedesktop.DBus.Properties",
            member: "Get",
            ..*owner
        };
        let arguments = [Value::Text(owner.interface), Value::Text(name)];
        let body = self.call(&get, &arguments)?;
        let mut reader = Reader::new(&body);
        match reader.signature() {
            Some("i") => reader.uint32().map(|x| i64::from(x as i32)),
            Some("x") => reader.uint64().map(|x| x as i64),
            _ => None,
        }
        .ok_or_else(|| bad("a property of another type"))
    }

    fn left(&self) -> io::Result<Option<std::time::Duration>> {
        let left = self.deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            Err(io::Error::new(
                ErrorKind::TimedOut,
                "the bus does not answer in time",
            ))
        } else {
            Ok(Some(left))
        }
    }

    fn send(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            self.stream.set_write_timeout(self.left()?)?;
            match self.stream.write(bytes) {
                Ok(0) => return Err(ErrorKind::WriteZero.into()),
                Ok(sent) => bytes = &bytes[sent..],
                Err(error) if passes(&error) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn fill(&mut self, mut buffer: &mut [u8]) -> io::Result<()> {
        while !buffer.is_empty() {
            self.stream.set_read_timeout(self.left()?)?;
            match self.stream.read(buffer) {
                Ok(0) => return Err(io::Error::new(ErrorKind::UnexpectedEof, "the bus hung up")),
                Ok(length) => buffer = &mut buffer[length..],
                Err(error) if passes(&error) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn line(&mut self) -> io::Result<Vec<u8>> {
        let mut line = Vec::new();
        while !line.ends_with(b"\r\n") {
            if line.len() == LONGEST_LINE {
                return Err(bad("a line without end"));
            }
            let mut byte = [0];
            self.fill(&mut byte)?;
            line.push(byte[0]);
        }
        Ok(line)
    }

    fn receive(&mut self) -> io::Result<Message> {
        let mut message = vec![0; FIXED_HEADER];
        self.fill(&mut message)?;
        let whole = message_length(&message).ok_or_else(|| bad("no message, or a huge one"))?;
        message.resize(whole, 0);
        self.fill(&mut message[FIXED_HEADER..])?;
        parse(&message).ok_or_else(|| bad("a message that makes no sense"))
    }
}

/// Interrupted or out of its slice of time: the deadline decides, not the call.
fn passes(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::Interrupted | ErrorKind::WouldBlock | ErrorKind::TimedOut
    )
}

/// The socket's name as the kernel takes it: a path, or a zero byte and an abstract name.
fn socket_name(address: &str) -> Option<Vec<u8>> {
    let pairs = address.trim().strip_prefix("unix:")?.split(',');
    let mut names = pairs.filter_map(|pair| {
        let (key, value) = pair.split_once('=')?;
        let value = unescape(value)?;
        match key {
            "path" => Some(value),
            "abstract" => Some([&[0], value.as_slice()].concat()),
            _ => None,
        }
    });
    names.next()
}

fn unescape(text: &str) -> Option<Vec<u8>> {
    let mut bytes = text.bytes();
    let mut plain = Vec::new();
    while let Some(byte) = bytes.next() {
        plain.push(if byte == b'%' {
            let digits = [bytes.next()?, bytes.next()?];
            u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
        } else {
            byte
        });
    }
    Some(plain)
}

/// Connects without ever waiting for a listener whose queue is full.
fn open(name: &[u8]) -> io::Result<UnixStream> {
    // SAFETY: all zeros is a valid address of no family.
    let mut address: libc::sockaddr_un = unsafe { zeroed() };
    address.sun_family = libc::AF_UNIX as libc::sa_family_t;
    // A path ends with a zero byte, so one place stays free.
    if name.len() >= address.sun_path.len() {
        return Err(io::Error::new(
            ErrorKind::InvalidInput,
            "the bus has too long a path",
        ));
    }
    for (place, &byte) in address.sun_path.iter_mut().zip(name) {
        *place = byte as libc::c_char;
    }
    let is_abstract = name.first() == Some(&0);
    let length = size_of::<libc::sa_family_t>() + name.len() + usize::from(!is_abstract);
    // SAFETY: asks for a descriptor; no memory is involved.
    let fd = unsafe {
        libc::socket(
            libc::AF_UNIX,
            libc::SOCK_STREAM | libc::SOCK_CLOEXEC | libc::SOCK_NONBLOCK,
            0,
        )
    };
    if fd < 0 {
        return Err(io::Error::last_os_error());
    }
    // SAFETY: the descriptor was just made and belongs to nobody else.
    let stream = UnixStream::from(unsafe { OwnedFd::from_raw_fd(fd) });
    // SAFETY: the address is valid for reading `length` bytes; the descriptor is open.
    let connected = unsafe {
        libc::connect(
            stream.as_raw_fd(),
            (&raw const address).cast(),
            length as libc::socklen_t,
        )
    };
    if connected != 0 {
        return Err(io::Error::last_os_error());
    }
    stream.set_nonblocking(false)?;
    Ok(stream)
}

/// Builds a message; little-endian, every value aligned to its own size.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    fn align(&mut self, to: usize) {
        self.bytes.resize(self.bytes.len().next_multiple_of(to), 0);
    }

    fn uint32(&mut self, value: u32) {
        self.align(4);
        self.bytes.extend(value.to_le_bytes());
    }

    fn uint64(&mut self, value: u64) {
        self.align(8);
        self.bytes.extend(value.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.uint32(text.len() as u32);
        self.bytes.extend(text.bytes());
        self.bytes.push(0);
    }

    fn signature(&mut self, signature: &str) {
        self.bytes.push(signature.len() as u8);
        self.bytes.extend(signature.bytes());
        self.bytes.push(0);
    }

    fn value(&mut self, value: Value<'_>) {
        match value {
            Value::Text(text) => self.text(text),
            Value::Int32(x) => self.uint32(x as u32),
            Value::Uint32(x) => self.uint32(x),
            Value::Uint64(x) => self.uint64(x),
        }
    }
}

impl Value<'_> {
    const fn signature(self) -> &'static str {
        match self {
            Self::Text(_) => "s",
            Self::Int32(_) => "i",
            Self::Uint32(_) => "u",
            Self::Uint64(_) => "t",
        }
    }
}

fn call_message(serial: u32, method: &Method<'_>, arguments: &[Value<'_>]) -> Vec<u8> {
    let mut body = Writer::default();
    for &argument in arguments {
        body.value(argument);
    }
    let mut message = Writer::default();
    message.bytes.extend([b'l', METHOD_CALL, 0, 1]);
    message.uint32(body.bytes.len() as u32);
    message.uint32(serial);
    message.uint32(0);
    let fields_from = message.bytes.len();
    for (code, kind, text) in [
        (1, "o", method.path),
        (2, "s", method.interface),
        (3, "s", method.member),
        (6, "s", method.destination),
    ] {
        message.align(8);
        message.bytes.push(code);
        message.signature(kind);
        message.text(text);
    }
    if !arguments.is_empty() {
        message.align(8);
        message.bytes.push(8);
        message.signature("g");
        let signature: String = arguments.iter().map(|a| a.signature()).collect();
        message.signature(&signature);
    }
    let fields = (message.bytes.len() - fields_from) as u32;
    message.bytes[12..16].copy_from_slice(&fields.to_le_bytes());
    message.align(8);
    message.bytes.extend(body.bytes);
    message.bytes
}

/// Byte order, type, flags, version, length of the body, serial, length of the fields.
const FIXED_HEADER: usize = 16;

/// Length of the whole message that begins with this fixed header, if it may be taken.
fn message_length(header: &[u8]) -> Option<usize> {
    let mut reader = Reader::new(header);
    let is_known = reader.byte()? == b'l';
    reader.at = 4;
    let body = reader.uint32()? as usize;
    reader.at = 12;
    let fields = reader.uint32()? as usize;
    let fits = is_known && body <= LARGEST_MESSAGE && fields <= LARGEST_MESSAGE;
    fits.then(|| (FIXED_HEADER + fields).next_multiple_of(8) + body)
}

fn parse(message: &[u8]) -> Option<Message> {
    let whole = message_length(message)?;
    let mut reader = Reader::new(message.get(..whole)?);
    reader.at = 1;
    let kind = reader.byte()?;
    reader.at = 4;
    let body = reader.uint32()? as usize;
    reader.at = 12;
    let fields_to = FIXED_HEADER + reader.uint32()? as usize;
    let mut reply_to = 0;
    while reader.at < fields_to {
        reader.align(8);
        let code = reader.byte()?;
        match reader.signature()? {
            "s" | "o" => {
                reader.text()?;
            }
            "g" => {
                reader.signature()?;
            }
            "u" => {
                let number = reader.uint32()?;
                if code == 5 {
                    reply_to = number;
                }
            }
            _ => return None,
        }
    }
    Some(Message {
        kind,
        reply_to,
        body: message[whole - body..whole].to_vec(),
    })
}

/// Reads values; `None` where the bytes do not suffice.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    fn align(&mut self, to: usize) {
        self.at = self.at.next_multiple_of(to);
    }

    fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let taken = self.bytes.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        Some(taken)
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1).map(|b| b[0])
    }

    fn uint32(&mut self) -> Option<u32> {
        self.align(4);
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn uint64(&mut self) -> Option<u64> {
        self.align(8);
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    fn zero_ended(&mut self, length: usize) -> Option<&'a str> {
        let text = std::str::from_utf8(self.take(length)?).ok()?;
        (self.byte()? == 0).then_some(text)
    }

    fn text(&mut self) -> Option<&'a str> {
        let length = self.uint32()? as usize;
        self.zero_ended(length)
    }

    fn signature(&mut self) -> Option<&'a str> {
        let length = usize::from(self.byte()?);
        self.zero_ended(length)
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::net::UnixListener;
    use std::time::Duration;

    use proptest::prelude::*;

    use super::*;

    const PING: Method<'_> = Method {
        destination: "a.b",
        path: "/a/b",
        interface: "a.b",
        member: "Ping",
    };

    /// A return with the body `7_u32`, as the specification has it.
    fn answer(reply_to: u32) -> Vec<u8> {
        let mut message = Writer::default();
        message.bytes.extend([b'l', METHOD_RETURN, 1, 1]);
        message.uint32(4);
        message.uint32(99);
        message.uint32(15);
        message.bytes.push(5);
        message.signature("u");
        message.uint32(reply_to);
        message.bytes.push(8);
        message.signature("g");
        // The fields end one byte into the next eight, which the body skips.
        message.signature("u");
        message.align(8);
        message.uint32(7);
        message.bytes
    }

    #[test]
    fn a_call_is_written_as_the_specification_says() {
        let bytes = call_message(1, &PING, &[Value::Uint64(2), Value::Int32(-1)]);
        let expected = [
            b"l\x01\x00\x01\x0c\x00\x00\x00\x01\x00\x00\x00\x43\x00\x00\x00".as_slice(),
            b"\x01\x01o\x00\x04\x00\x00\x00/a/b\x00\x00\x00\x00",
            b"\x02\x01s\x00\x03\x00\x00\x00a.b\x00\x00\x00\x00\x00",
            b"\x03\x01s\x00\x04\x00\x00\x00Ping\x00\x00\x00\x00",
            b"\x06\x01s\x00\x03\x00\x00\x00a.b\x00\x00\x00\x00\x00",
            b"\x08\x01g\x00\x02ti\x00",
            b"\x02\x00\x00\x00\x00\x00\x00\x00\xff\xff\xff\xff",
        ]
        .concat();
        assert_eq!(bytes.len(), expected.len());
        assert_eq!(bytes[16..], expected[16..]);
    }

    #[test]
    fn addresses_name_sockets() {
        assert_eq!(
            socket_name("unix:path=/run/a%20b,guid=1"),
            Some(b"/run/a b".to_vec())
        );
        assert_eq!(
            socket_name("unix:guid=1,abstract=/x"),
            Some(b"\0/x".to_vec())
        );
        for address in [
            "tcp:host=localhost,port=1",
            "unix:",
            "",
            "unix:path=%4",
            "unix:path=%zz",
        ] {
            assert_eq!(socket_name(address), None, "{address}");
        }
    }

    /// What asking a bus that behaves like `bus` comes to.
    fn ask(bus: impl FnOnce(UnixStream) + Send + 'static) -> io::Result<Vec<u8>> {
        let folder = std::env::temp_dir();
        let path = folder.join(format!("palpate-bus-{:?}", std::thread::current().id()));
        let _ = std::fs::remove_file(&path);
        let listener = UnixListener::bind(&path).expect("a socket");
        let bus = std::thread::spawn(move || bus(listener.accept().expect("a caller").0));
        let deadline = Instant::now() + Duration::from_millis(300);
        let address = format!("tcp:host=a;unix:path={}", path.display());
        let answer = Bus::connect(&address, deadline).and_then(|mut bus| bus.call(&PING, &[]));
        bus.join().expect("no panic");
        std::fs::remove_file(path).expect("it is there");
        answer
    }

    fn heard(stream: &mut UnixStream, length: usize) {
        let mut bytes = vec![0; length];
        stream.read_exact(&mut bytes).expect("so many bytes");
    }

    /// Shakes hands and answers Hello.
    fn welcome(stream: &mut UnixStream) {
        // SAFETY: touches no memory.
        let user = unsafe { libc::geteuid() }.to_string();
        heard(stream, 1 + "AUTH EXTERNAL \r\n".len() + 2 * user.len());
        stream.write_all(b"OK 00\r\n").expect("sent");
        heard(stream, "BEGIN\r\n".len() + 128);
        stream.write_all(&answer(1)).expect("sent");
    }

    #[test]
    fn an_answer_is_found_behind_other_messages() {
        let got = ask(|mut stream| {
            welcome(&mut stream);
            stream.write_all(&answer(77)).expect("sent");
            for byte in answer(2) {
                stream.write_all(&[byte]).expect("sent");
            }
            let _ = stream.read(&mut [0; 512]);
        });
        assert_eq!(got.expect("an answer"), 7_u32.to_le_bytes());
    }

    #[test]
    fn a_bus_that_is_absent_is_an_error() {
        let deadline = Instant::now() + Duration::from_millis(300);
        assert!(Bus::connect("unix:path=/nowhere/bus", deadline).is_err());
        assert!(Bus::connect("", deadline).is_err());
        assert!(Bus::connect(&format!("unix:path=/{}", "a".repeat(200)), deadline).is_err());
    }

    #[test]
    fn a_bus_that_is_silent_is_given_up() {
        let error = ask(|mut stream| while stream.read(&mut [0; 64]).is_ok_and(|n| n > 0) {});
        assert_eq!(error.expect_err("no answer").kind(), ErrorKind::TimedOut);
        let error = ask(|mut stream| {
            welcome(&mut stream);
            while stream.read(&mut [0; 64]).is_ok_and(|n| n > 0) {}
        });
        assert_eq!(error.expect_err("no answer").kind(), ErrorKind::TimedOut);
    }

    #[test]
    fn a_bus_that_hangs_up_is_given_up() {
        let error = ask(|mut stream| welcome(&mut stream)).expect_err("no answer");
        let kinds = [
            ErrorKind::UnexpectedEof,
            ErrorKind::BrokenPipe,
            ErrorKind::ConnectionReset,
        ];
        assert!(kinds.contains(&error.kind()), "{error}");
    }

    #[test]
    fn a_bus_that_talks_without_end_is_given_up() {
        let error = ask(|mut stream| {
            let _ = stream.read(&mut [0; 64]);
            while stream.write_all(&[b'O'; 64]).is_ok() {}
        });
        assert_eq!(error.expect_err("no answer").kind(), ErrorKind::InvalidData);
        let error = ask(|mut stream| {
            welcome(&mut stream);
            while stream.write_all(&answer(1000)).is_ok() {}
        });
        assert_eq!(error.expect_err("no answer").kind(), ErrorKind::TimedOut);
        let error = ask(|mut stream| {
            welcome(&mut stream);
            let _ = stream.read(&mut [0; 512]);
            let _ = stream.write_all(&[b'l', 2, 1, 1, 255, 255, 255, 127, 0, 0, 0, 0, 0, 0, 0, 0]);
        });
        assert_eq!(error.expect_err("no answer").kind(), ErrorKind::InvalidData);
    }

    proptest! {
        #[test]
        fn no_bytes_make_a_reader_panic(
            mut bytes in proptest::collection::vec(any::<u8>(), 16..200),
            hit in 0_usize..60, by: u8,
        ) {
            bytes[0] = b'l';
            let _ = parse(&bytes);
            bytes[4..8].fill(0);
            bytes[12..16].copy_from_slice(&64_u32.to_le_bytes());
            let _ = parse(&bytes);
            let mut sound = answer(3);
            prop_assert!(parse(&sound).is_some());
            if hit < sound.len() {
                sound[hit] ^= by;
                let _ = parse(&sound);
            }
        }
    }
}
