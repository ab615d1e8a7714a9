//! Questions to services on D-Bus by libdbus, all of them within one deadline.
//!
//! libdbus gives calls a time, but connecting none: it waits for as long as a bus keeps the
//! handshake waiting. So a thread of its own connects, and is left alone with it when time is up.

use std::io::{self, ErrorKind};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use dbus::Error;
use dbus::arg::{AppendAll, ReadAll, RefArg};
use dbus::blocking::Proxy;
use dbus::blocking::stdintf::org_freedesktop_dbus::Properties;
use dbus::channel::Channel;

/// libdbus counts time in whole milliseconds: with these, a call that it gives up is past ours.
const ROUNDING: Duration = Duration::from_millis(2);

/// Address of a service on the bus.
#[derive(Debug, Clone, Copy)]
pub struct Service {
    pub name: &'static str,
    pub path: &'static str,
    pub interface: &'static str,
}

/// A connection of our own whose calls end at a deadline.
#[derive(Debug)]
pub struct Bus {
    channel: Channel,
    deadline: Instant,
}

impl Bus {
    /// Connects to the first address of a list (`unix:path=...;unix:abstract=...`) that answers.
    ///
    /// # Errors
    /// `TimedOut` at the deadline; others when there is no bus, or it refuses or hangs up.
    pub fn connect(addresses: &str, deadline: Instant) -> io::Result<Self> {
        let addresses = addresses.to_owned();
        let (tell, told) = mpsc::channel();
        let connecting = thread::Builder::new()
            .name("palpate-bus".to_owned())
            .spawn(move || {
                // Where nobody waits any more, this closes the connection.
                let _ = tell.send(open(&addresses));
            })?;
        let opened = told
            .recv_timeout(left(deadline)?)
            .map_err(|error| match error {
                RecvTimeoutError::Timeout => late(),
                RecvTimeoutError::Disconnected => io::Error::other("connecting to the bus failed"),
            })?;
        // It has told, so it is ending.
        let _ = connecting.join();
        let channel = opened.map_err(|error| io::Error::other(words(&error)))?;
        Ok(Self { channel, deadline })
    }

    /// Calls a method.
    ///
    /// # Errors
    /// `TimedOut` at the deadline; others with the service's own words when it refuses, or the
    /// bus fails.
    pub fn call<R: ReadAll>(
        &self,
        service: &Service,
        method: &str,
        arguments: impl AppendAll,
    ) -> io::Result<R> {
        self.proxy(service)?
            .method_call(service.interface, method, arguments)
            .map_err(|error| self.failure(&error))
    }

    /// Reads a property that is any integer.
    ///
    /// # Errors
    /// As those of `call`; `InvalidData` when it is no integer.
    pub fn integer(&self, service: &Service, property: &str) -> io::Result<i64> {
        let value: Box<dyn RefArg> = self
            .proxy(service)?
            .get(service.interface, property)
            .map_err(|error| self.failure(&error))?;
        value.as_i64().ok_or_else(|| {
            io::Error::new(ErrorKind::InvalidData, format!("{property} is no integer"))
        })
    }

    fn proxy(&self, service: &Service) -> io::Result<Proxy<'static, &Channel>> {
        let timeout = left(self.deadline)? + ROUNDING;
        Ok(Proxy::new(
            service.name,
            service.path,
            timeout,
            &self.channel,
        ))
    }

    fn failure(&self, error: &Error) -> io::Error {
        if self.deadline <= Instant::now() {
            late()
        } else {
            io::Error::other(words(error))
        }
    }
}

fn open(addresses: &str) -> Result<Channel, Error> {
    let mut channel = Channel::open_private(addresses)?;
    channel.register()?;
    Ok(channel)
}

fn left(deadline: Instant) -> io::Result<Duration> {
    let left = deadline.saturating_duration_since(Instant::now());
    if left.is_zero() {
        Err(late())
    } else {
        Ok(left)
    }
}

fn late() -> io::Error {
    io::Error::new(ErrorKind::TimedOut, "the bus does not answer in time")
}

fn words(error: &Error) -> String {
    let told = error.message().filter(|message| !message.is_empty());
    told.or(error.name())
        .unwrap_or("no reason given")
        .to_owned()
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader, Read, Write};
    use std::os::unix::net::{UnixListener, UnixStream};
    use std::sync::mpsc::Receiver;
    use std::sync::{Mutex, PoisonError};

    use super::*;

    const SERVICE: Service = Service {
        name: "a.b",
        path: "/a/b",
        interface: "a.b",
    };
    const SHORT: Duration = Duration::from_millis(300);
    /// Never waited for, where all is well.
    const LONG: Duration = Duration::from_secs(60);

    /// One connection at a time: libdbus lets a second one wait for the first one's handshake.
    static ALONE: Mutex<()> = Mutex::new(());

    /// What asking a bus that behaves like `bus` comes to. That is told when the asking is over.
    fn ask(
        patience: Duration,
        bus: impl FnOnce(UnixStream, Receiver<()>) + Send + 'static,
    ) -> io::Result<()> {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let name = format!("palpate-bus-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = std::fs::remove_file(&path);
        let listener = UnixListener::bind(&path).expect("a socket");
        let (over, is_over) = mpsc::channel();
        let bus = thread::spawn(move || bus(listener.accept().expect("a caller").0, is_over));
        let address = format!("unix:path=/nowhere/bus;unix:path={}", path.display());
        let answer = Bus::connect(&address, Instant::now() + patience)
            .and_then(|bus| bus.call(&SERVICE, "Ping", (2_u64,)));
        drop(over);
        bus.join().expect("no panic");
        std::fs::remove_file(path).expect("it is there");
        answer
    }

    fn shake_hands(stream: &UnixStream) {
        for line in BufReader::new(stream).lines() {
            let reply: &[u8] = match line.expect("a line") {
                line if line.starts_with("\0AUTH") => b"OK 0123456789abcdef0123456789abcdef\r\n",
                line if line.starts_with("BEGIN") => return,
                _ => b"ERROR\r\n",
            };
            (&*stream).write_all(reply).expect("sent");
        }
    }

    /// Shakes hands and answers Hello by a name, laid out as the specification says.
    fn welcome(stream: &UnixStream) {
        shake_hands(stream);
        let answer = [
            b"l\x02\x01\x01\x09\0\0\0\x09\0\0\0\x0f\0\0\0".as_slice(),
            b"\x05\x01u\0\x01\0\0\0\x08\x01g\0\x01s\0\0",
            b"\x04\0\0\0:1.1\0",
        ];
        (&*stream).write_all(&answer.concat()).expect("sent");
    }

    /// An empty answer to a call.
    fn answer(call: u8) -> [u8; 24] {
        let mut message = *b"l\x02\x01\x01\0\0\0\0\x09\0\0\0\x08\0\0\0\x05\x01u\0\0\0\0\0";
        message[20] = call;
        message
    }

    fn kind(answer: io::Result<()>) -> ErrorKind {
        answer.expect_err("no answer").kind()
    }

    #[test]
    fn an_answer_is_found_behind_other_messages() {
        let got = ask(LONG, |mut stream, _| {
            welcome(&stream);
            while stream.write_all(&answer(77)).is_ok() && stream.write_all(&answer(2)).is_ok() {}
        });
        got.expect("an answer");
    }

    #[test]
    fn a_bus_that_is_absent_is_an_error() {
        for address in [
            "unix:path=/nowhere/bus",
            "",
            &format!("unix:path=/{}", "a".repeat(200)),
        ] {
            let error = Bus::connect(address, Instant::now() + LONG).expect_err("no bus");
            assert_eq!(error.kind(), ErrorKind::Other, "{error}");
        }
    }

    #[test]
    fn a_bus_that_is_silent_is_given_up() {
        let silent = |_: UnixStream, is_over: Receiver<()>| is_over.recv().unwrap_or_default();
        assert_eq!(kind(ask(SHORT, silent)), ErrorKind::TimedOut);
        let answer = ask(SHORT, |stream, is_over| {
            shake_hands(&stream);
            is_over.recv().unwrap_or_default();
        });
        assert_eq!(kind(answer), ErrorKind::TimedOut);
        let answer = ask(SHORT, |stream, is_over| {
            welcome(&stream);
            is_over.recv().unwrap_or_default();
        });
        assert_eq!(kind(answer), ErrorKind::TimedOut);
    }

    #[test]
    fn a_bus_that_hangs_up_is_given_up() {
        assert_eq!(kind(ask(LONG, |_, _| {})), ErrorKind::Other);
        let answer = ask(LONG, |stream, _| shake_hands(&stream));
        assert_eq!(kind(answer), ErrorKind::Other);
        let answer = ask(LONG, |stream, _| welcome(&stream));
        assert_eq!(kind(answer), ErrorKind::Other);
    }

    #[test]
    fn a_bus_that_talks_without_end_is_given_up() {
        let answered = ask(LONG, |mut stream, _| {
            let _ = stream.read(&mut [0; 64]);
            while stream.write_all(&[b'O'; 64]).is_ok() {}
        });
        assert_eq!(kind(answered), ErrorKind::Other);
        let flood = |mut stream: UnixStream, is_over: Receiver<()>| {
            while is_over.try_recv() != Err(mpsc::TryRecvError::Disconnected)
                && stream.write_all(&answer(77)).is_ok()
            {}
        };
        let answered = ask(SHORT, move |stream, is_over| {
            shake_hands(&stream);
            flood(stream, is_over);
        });
        assert_eq!(kind(answered), ErrorKind::TimedOut);
        let answered = ask(SHORT, move |stream, is_over| {
            welcome(&stream);
            flood(stream, is_over);
        });
        assert_eq!(kind(answered), ErrorKind::TimedOut);
        let answered = ask(LONG, |mut stream, is_over| {
            welcome(&stream);
            let _ = stream.write_all(b"l\x02\x01\x01\xff\xff\xff\x7f\x09\0\0\0\0\0\0\0");
            is_over.recv().unwrap_or_default();
        });
        assert_eq!(kind(answered), ErrorKind::Other);
    }
}
