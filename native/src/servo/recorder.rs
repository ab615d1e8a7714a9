//! Recording of every tick: a ring of its own, emptied into memory by a thread without deadlines.
//!
//! The tick only pushes into the ring ([`Tape`]); what may wait or allocate happens at its other end
//! ([`Recorder`]). Neither of them knows of Python, so a busy interpreter costs no tick.

use std::sync::atomic::{
    AtomicBool, AtomicU64, AtomicUsize,
    Ordering::{Acquire, Relaxed, Release},
};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use rtrb::{Consumer, Producer, RingBuffer};

use crate::servo::child_thread::ChildThread;
use crate::servo::paced::locked;
use crate::servo::snapshot::Sample;

/// Longest delay of the thread that empties the ring without a loss, s.
pub const RING_SECONDS: u32 = 10;
/// The ring is emptied this often.
const PAUSE: Duration = Duration::from_millis(20);
/// Memory is asked for in pieces of this many samples.
const CHUNK: usize = 8192;

/// A ring whose memory the system has handed out already: untouched, each new page would stop the
/// tick that reaches it first.
pub fn touched_ring(capacity: usize) -> (Producer<Sample>, Consumer<Sample>) {
    let (mut producer, mut consumer) = RingBuffer::new(capacity.max(1));
    while producer.push(Sample::default()).is_ok() {}
    while consumer.pop().is_ok() {}
    (producer, consumer)
}

#[derive(Debug, Default)]
struct Shared {
    /// Ticks are wanted.
    on: AtomicBool,
    /// Ticks that found the ring full, or for which there was no memory.
    lost: AtomicU64,
    /// Ticks in memory.
    kept: AtomicUsize,
}

/// The tick's end of the ring.
pub struct Tape {
    ring: Producer<Sample>,
    shared: Arc<Shared>,
}

impl Tape {
    /// Records a tick if ticks are wanted. Never waits; a full ring is a loss that is counted.
    pub fn put(&mut self, sample: Sample) {
        if self.shared.on.load(Acquire) && self.ring.push(sample).is_err() {
            self.shared.lost.fetch_add(1, Relaxed);
        }
    }
}

struct Store {
    ring: Consumer<Sample>,
    chunks: Vec<Vec<Sample>>,
    count: usize,
    limit: usize,
}

impl Store {
    /// Takes what is in the ring, up to the limit.
    fn drain(&mut self, shared: &Shared) {
        for _ in 0..self.ring.slots() {
            let Ok(sample) = self.ring.pop() else { break };
            if self.count == self.limit {
                continue;
            }
            if self.keep(sample) {
                self.count += 1;
            } else {
                shared.lost.fetch_add(1, Relaxed);
            }
        }
        shared.kept.store(self.count, Relaxed);
        if self.count == self.limit {
            shared.on.store(false, Release);
        }
    }

    /// False when there is no memory left.
    fn keep(&mut self, sample: Sample) -> bool {
        if self.chunks.last().is_none_or(|c| c.len() == c.capacity()) {
            let mut chunk = Vec::new();
            let room = CHUNK.min(self.limit - self.count);
            if chunk.try_reserve_exact(room).is_err() || self.chunks.try_reserve(1).is_err() {
                return false;
            }
            self.chunks.push(chunk);
        }
        if let Some(chunk) = self.chunks.last_mut() {
            chunk.push(sample);
        }
        true
    }
}

/// The other end of the ring, and the thread that empties it while ticks are wanted.
pub struct Recorder {
    shared: Arc<Shared>,
    store: Arc<Mutex<Store>>,
    thread: Mutex<Option<ChildThread>>,
}

impl Recorder {
    /// Both ends of a ring of `capacity` samples; nothing is recorded yet.
    pub fn new(capacity: usize) -> (Tape, Self) {
        let (producer, consumer) = touched_ring(capacity);
        let shared = Arc::new(Shared::default());
        let tape = Tape {
            ring: producer,
            shared: shared.clone(),
        };
        let store = Store {
            ring: consumer,
            chunks: Vec::new(),
            count: 0,
            limit: 0,
        };
        let recorder = Self {
            shared,
            store: Arc::new(Mutex::new(store)),
            thread: Mutex::new(None),
        };
        (tape, recorder)
    }

    /// Records `limit` ticks from the next one on, instead of what was recorded before.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(&self, limit: usize) -> std::io::Result<()> {
        self.stop();
        let mut thread = locked(&self.thread);
        let mut store = locked(&self.store);
        // The last tick of an earlier recording may have come after its end.
        while store.ring.pop().is_ok() {}
        (store.chunks, store.count, store.limit) = (Vec::new(), 0, limit);
        self.shared.lost.store(0, Relaxed);
        self.shared.kept.store(0, Relaxed);
        self.shared.on.store(limit > 0, Release);
        let spawned = ChildThread::spawn("palpate-recorder", {
            let (shared, store) = (self.shared.clone(), self.store.clone());
            move || {
                while shared.on.load(Acquire) {
                    std::thread::park_timeout(PAUSE);
                    locked(&store).drain(&shared);
                }
            }
        });
        match spawned {
            Ok(spawned) => *thread = Some(spawned),
            Err(problem) => {
                self.shared.on.store(false, Release);
                return Err(problem);
            }
        }
        Ok(())
    }

    /// Ends the recording, which stays; nothing happens the second time.
    pub fn stop(&self) {
        self.shared.on.store(false, Release);
        if let Some(thread) = locked(&self.thread).take() {
            thread.thread().unpark();
            // It cannot panic: it moves numbers, and asks for memory with a plan for none.
            thread.join();
        }
        locked(&self.store).drain(&self.shared);
    }

    /// Whether ticks are wanted: started, not stopped, and not yet as many as asked.
    pub fn is_on(&self) -> bool {
        self.shared.on.load(Acquire)
    }

    /// Ticks in memory; those of the last moments may still be in the ring.
    pub fn count(&self) -> usize {
        self.shared.kept.load(Relaxed)
    }

    /// Ticks that are missing in the recording.
    pub fn lost(&self) -> u64 {
        self.shared.lost.load(Relaxed)
    }

    /// Hands the ticks recorded until now to `read`, in order, in pieces.
    pub fn read<R>(&self, read: impl FnOnce(&[Vec<Sample>]) -> R) -> R {
        let mut store = locked(&self.store);
        store.drain(&self.shared);
        read(&store.chunks)
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.stop();
    }
}
