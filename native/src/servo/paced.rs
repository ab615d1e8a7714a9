//! A thread that wakes at a fixed rate.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use crate::clock::realtime::{Granted, ask_for_real_time};
use crate::clock::timing::{Pace, Timing, Waking};
use crate::servo::child_thread::ChildThread;

/// A thread that wakes at a fixed rate until it is stopped.
#[derive(Debug)]
pub struct Paced {
    stop: Arc<AtomicBool>,
    thread: Mutex<Option<ChildThread>>,
    timing: Arc<Timing>,
    realtime: Arc<OnceLock<Granted>>,
}

impl Paced {
    pub(super) fn spawn(
        name: &str,
        rate_hz: u32,
        waking: Waking,
        work: impl FnOnce(&mut dyn FnMut() -> Option<f64>) + Send + 'static,
    ) -> std::io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let timing = Arc::new(Timing::default());
        let realtime = Arc::new(OnceLock::new());
        let thread = ChildThread::spawn(name, {
            let (stop, timing, realtime) = (stop.clone(), timing.clone(), realtime.clone());
            move || {
                touch_stack();
                let (granted, _tenure) = ask_for_real_time(rate_hz);
                let _ = realtime.set(granted);
                let mut pace = Pace::new(rate_hz, waking);
                work(&mut || {
                    let wake = pace.wait(&timing, || !stop.load(Relaxed));
                    wake.map(|wake| wake.seconds)
                });
            }
        })?;
        Ok(Self {
            stop,
            thread: Mutex::new(Some(thread)),
            timing,
            realtime,
        })
    }

    /// A thread that does nothing but wake: what the machine can do at best.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn bare(rate_hz: u32, waking: Waking) -> std::io::Result<Self> {
        Self::spawn(
            "palpate-bare",
            rate_hz,
            waking,
            |wake| {
                while wake().is_some() {}
            },
        )
    }

    /// Its timing counters.
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Answer of the system to the wish for real-time priority.
    pub fn realtime(&self) -> String {
        let granted = self.realtime.get();
        granted.map_or_else(|| "not asked yet".to_owned(), Granted::text)
    }

    /// Whether the thread has not been stopped and has not ended.
    pub fn is_running(&self) -> bool {
        locked(&self.thread)
            .as_ref()
            .is_some_and(ChildThread::is_running)
    }

    /// Ends the thread and waits for it; nothing happens the second time.
    pub fn stop(&self) {
        self.stop.store(true, Relaxed);
        let thread = locked(&self.thread).take();
        if let Some(thread) = thread {
            // A panic was caught inside and is told in the last snapshot.
            thread.join();
        }
    }
}

impl Drop for Paced {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Has the system hand out the stack now: each page untouched would stop the tick that reaches it
/// first.
#[inline(never)]
fn touch_stack() {
    const PAGE: usize = 4096;
    let mut stack = [0_u8; 64 * PAGE];
    for place in stack.iter_mut().step_by(PAGE) {
        // SAFETY: a place of an array of our own; volatile, so that the compiler leaves it there.
        unsafe { std::ptr::write_volatile(place, 1) };
    }
}

/// These locks are among callers only; the servo thread holds none.
pub fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
