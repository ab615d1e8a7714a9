//! What a port needs now and then that may take its time, done by a thread of its own: asked for and
//! answered without waiting.
//!
//! Throwing away what a driver holds takes locks that the kernel's workers hold too (Linux:
//! `tty_buffer_flush` of a pseudo-terminal; other drivers wait for their hardware), and a worker gets its
//! turn when busy processes let it.

use std::io;
use std::thread::{Builder, Thread};
use std::time::Duration;

use rtrb::{Consumer, Producer, RingBuffer};

use crate::device::serial::twin::Twin;
use crate::guardian::Guardian;

/// Another try after a guardian that could not be started.
const PAUSE: Duration = Duration::from_millis(200);
/// One of each kind may be under way.
const MOST: usize = 2;

/// What is asked for.
#[derive(Debug)]
pub enum Errand {
    /// Throw away what the driver holds.
    Discard,
    /// Start a guardian for one that has ended, which is handed back.
    Guard(Guardian),
    /// Try that again in a while.
    TryAgain,
}

/// What came of it.
#[derive(Debug)]
pub enum Done {
    /// It is thrown away.
    Discarded,
    /// There is another guardian, or none.
    Guarded(Option<Guardian>),
}

/// The end of whoever asks.
#[derive(Debug)]
pub struct Errands {
    /// Taken when this is dropped, which ends the thread.
    asked: Option<Producer<Errand>>,
    done: Consumer<Done>,
    thread: Thread,
}

impl Errands {
    /// Starts the thread, which sleeps until it is asked; it is not waited for, as a driver may hold it
    /// up for as long as it likes.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn of(port: Twin) -> io::Result<Self> {
        let (asked, errands) = RingBuffer::new(MOST);
        let (answer, done) = RingBuffer::new(MOST);
        let thread = Builder::new()
            .name("palpate-errand".to_owned())
            .spawn(move || serve(&port, errands, answer))?;
        Ok(Self {
            asked: Some(asked),
            done,
            thread: thread.thread().clone(),
        })
    }

    /// Asks; there is room for one of each kind that has not been answered.
    pub fn ask(&mut self, errand: Errand) {
        if let Some(asked) = &mut self.asked {
            // What finds no room was asked for already.
            let _ = asked.push(errand);
            self.thread.unpark();
        }
    }

    /// What has been done since the last call, one at a time.
    pub fn done(&mut self) -> Option<Done> {
        self.done.pop().ok()
    }
}

impl Drop for Errands {
    fn drop(&mut self) {
        drop(self.asked.take());
        self.thread.unpark();
    }
}

fn serve(port: &Twin, mut errands: Consumer<Errand>, mut answer: Producer<Done>) {
    loop {
        let Ok(errand) = errands.pop() else {
            if errands.is_abandoned() {
                return;
            }
            std::thread::park();
            continue;
        };
        let done = match errand {
            Errand::Discard => {
                port.discard();
                Done::Discarded
            }
            Errand::Guard(gone) => {
                drop(gone);
                Done::Guarded(port.guardian().ok())
            }
            Errand::TryAgain => {
                std::thread::sleep(PAUSE);
                Done::Guarded(port.guardian().ok())
            }
        };
        // A new guardian is dismissed if nobody is there to take it.
        let _ = answer.push(done);
    }
}
