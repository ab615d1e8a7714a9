//! Opens a port again on a thread of its own: opening and closing may take seconds, and the tick must
//! not wait for either.

use std::io;
use std::task::Poll;
use std::thread::{Builder, Thread};

use rtrb::{Consumer, Producer, RingBuffer};

use crate::device::serial::guarded::{GuardedPort, GuardedWire};
use crate::device::serial::wire::Opener;

/// What opens one port, at the start and whenever it was away.
///
/// The thread sleeps until it is asked; it is not waited for, as a driver may hold it up for as long as
/// it likes.
#[derive(Debug)]
pub struct Reopening {
    port: GuardedPort,
    /// Taken when this is dropped, which ends the thread.
    requests: Option<Producer<Option<GuardedWire>>>,
    answers: Consumer<Option<GuardedWire>>,
    thread: Thread,
}

impl Reopening {
    /// Starts the thread; nothing is opened yet.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn of(port: GuardedPort) -> io::Result<Self> {
        let (requests, asked) = RingBuffer::new(1);
        let (answer, answers) = RingBuffer::new(1);
        let opens = port.clone();
        let thread = Builder::new()
            .name("palpate-port".to_owned())
            .spawn(move || serve(&opens, asked, answer))?;
        Ok(Self {
            port,
            requests: Some(requests),
            answers,
            thread: thread.thread().clone(),
        })
    }
}

/// Closes what is gone, opens the port, and hands it over, until nobody can ask any more.
fn serve(
    port: &GuardedPort,
    mut asked: Consumer<Option<GuardedWire>>,
    mut answer: Producer<Option<GuardedWire>>,
) {
    loop {
        let Ok(gone) = asked.pop() else {
            if asked.is_abandoned() {
                return;
            }
            std::thread::park();
            continue;
        };
        // First, for the old one may still keep others out.
        drop(gone);
        // Closed again if nobody is there to take it.
        let _ = answer.push(port.open().ok());
    }
}

impl Opener for Reopening {
    type Wire = GuardedWire;

    fn open(&mut self) -> io::Result<GuardedWire> {
        self.port.open()
    }

    fn ask(&mut self, gone: Option<GuardedWire>) {
        // There is room: whoever asks has had the answer to what was asked before.
        if let Some(requests) = &mut self.requests
            && requests.push(gone).is_ok()
        {
            self.thread.unpark();
        }
    }

    fn answer(&mut self) -> Poll<Option<GuardedWire>> {
        self.answers.pop().map_or(Poll::Pending, Poll::Ready)
    }
}

impl Drop for Reopening {
    fn drop(&mut self) {
        drop(self.requests.take());
        self.thread.unpark();
    }
}
