//! A serial port with its guardian.

use std::io;

use crate::device::serial::errands::{Done, Errand, Errands};
use crate::device::serial::port::SerialPort;
use crate::device::serial::wire::{TwinnedWire, Wire};
use crate::guardian::{Guardian, Watch};

/// A serial port, and whether its device keeps its force when nobody speaks to it any more.
#[derive(Debug, Clone)]
pub struct GuardedPort {
    /// The port.
    pub port: SerialPort,
    /// It is not opened without a guardian, and given no force.
    pub needs_guardian: bool,
}

impl GuardedPort {
    /// Opens the port and starts the guardian. May take seconds.
    ///
    /// # Errors
    /// When there is no port, or somebody else has it, or it needs a guardian and there is none.
    pub fn open(&self) -> io::Result<GuardedWire> {
        let wire = self.port.open()?;
        let twin = wire.twin()?;
        let guardian = match twin.guardian() {
            Err(error) if self.needs_guardian => return Err(error),
            guardian => guardian.ok(),
        };
        Ok(GuardedWire {
            guardian,
            errands: Errands::of(twin)?,
            wire,
            needs_guardian: self.needs_guardian,
            is_guarding: false,
            is_discarding: false,
            has_discarded: false,
        })
    }
}

/// An open port, watched if that can be.
#[derive(Debug)]
pub struct GuardedWire {
    /// Before the wire: it is dismissed first.
    guardian: Option<Guardian>,
    errands: Errands,
    wire: Box<dyn TwinnedWire>,
    needs_guardian: bool,
    /// Another guardian is being started.
    is_guarding: bool,
    is_discarding: bool,
    has_discarded: bool,
}

impl GuardedWire {
    fn look_what_is_done(&mut self) {
        while let Some(done) = self.errands.done() {
            match done {
                Done::Discarded => {
                    self.is_discarding = false;
                    self.has_discarded = true;
                }
                Done::Guarded(None) if self.needs_guardian => self.errands.ask(Errand::TryAgain),
                Done::Guarded(guardian) => {
                    self.is_guarding = false;
                    self.guardian = guardian;
                }
            }
        }
    }
}

impl Wire for GuardedWire {
    fn waiting(&mut self) -> io::Result<usize> {
        self.wire.waiting()
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.wire.read(buffer)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.wire.write(bytes)
    }

    fn queued(&mut self) -> usize {
        self.wire.queued()
    }

    fn discard(&mut self) {
        if !self.is_discarding {
            self.is_discarding = true;
            self.errands.ask(Errand::Discard);
        }
    }

    fn has_discarded(&mut self) -> bool {
        self.look_what_is_done();
        std::mem::take(&mut self.has_discarded)
    }

    fn bits_per_second(&self) -> Option<u32> {
        self.wire.bits_per_second()
    }

    fn is_guarded(&self) -> bool {
        self.guardian.is_some()
    }

    fn dismiss(&mut self) {
        if let Some(guardian) = &mut self.guardian {
            guardian.dismiss();
        }
    }

    fn live(&mut self, last_word: &[u8]) -> Watch {
        self.look_what_is_done();
        let watch = match &mut self.guardian {
            Some(guardian) => guardian.live(last_word),
            None if self.is_guarding => Watch::Absent,
            // It was refused from the start, or since: the device lets go by itself.
            None => Watch::Kept,
        };
        if watch == Watch::Absent
            && let Some(mut gone) = self.guardian.take()
        {
            // Another one takes its place; the device keeps its host.
            gone.dismiss();
            self.is_guarding = true;
            self.errands.ask(Errand::Guard(gone));
        }
        watch
    }
}
