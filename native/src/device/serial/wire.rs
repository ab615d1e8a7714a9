//! An open line that never waits: it reads what is there and writes what fits.

use std::fmt::Debug;
use std::io;
use std::task::Poll;

use crate::device::serial::twin::Twin;
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
    /// The device was let go: its guardian has nothing more to say when the line is left.
    fn dismiss(&mut self) {}
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

/// A wire of the system's, whose port may be used by a thread besides the tick's.
pub trait TwinnedWire: Wire + Debug {
    /// The port once more, for what may wait.
    ///
    /// # Errors
    /// When the system gives no handle.
    fn twin(&self) -> io::Result<Twin>;
}
