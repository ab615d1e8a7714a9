//! A thread and the process that has it: after a fork the other process has only its memory.

use std::thread::{Builder, JoinHandle, Thread};

/// A thread to be ended by the process that started it.
///
/// A fork copies this, but not the thread. In the copy there is nothing to wait for, and the
/// system's calls on the handle are errors there.
#[derive(Debug)]
pub struct ChildThread {
    handle: JoinHandle<()>,
    process: u32,
}

impl ChildThread {
    /// Starts a thread.
    ///
    /// # Errors
    /// When the system gives none.
    pub fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> std::io::Result<Self> {
        Ok(Self {
            handle: Builder::new().name(name.to_owned()).spawn(work)?,
            process: std::process::id(),
        })
    }

    fn is_here(&self) -> bool {
        self.process == std::process::id()
    }

    /// Whether it has not ended, in this process.
    pub fn is_running(&self) -> bool {
        self.is_here() && !self.handle.is_finished()
    }

    /// Handle to wake it.
    pub fn thread(&self) -> &Thread {
        self.handle.thread()
    }

    /// Waits for its end. Its panic, if any, is its own affair.
    pub fn join(self) {
        if self.is_here() {
            let _ = self.handle.join();
        } else {
            std::mem::forget(self.handle);
        }
    }
}
