//! An ordinary user's servo beside busy threads on every processor: whatever the kernel's workers would
//! have to do for it, it waits for none of them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering::Relaxed};
use std::thread::{available_parallelism, sleep};
use std::time::Duration;

use glam::DVec3;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::serial::port::SerialPort;
use palpate_servo::device::serial::reopening::Reopening;
use palpate_servo::device::{Device, DeviceFrame, LinkReport, Reading};
use palpate_servo::servo::thread::Running;

use crate::{OPTIONS, board, bodies, guarded, settings, terminal};

const NOBODY: libc::c_long = 65_534;

/// Makes this thread, and all that it starts, those of an ordinary user, who is given no real-time
/// priority. Nothing happens to a user who is one.
fn become_nobody() {
    // SAFETY: no memory is touched. The call itself changes one thread, the library's function all.
    unsafe { libc::syscall(libc::SYS_setresuid, NOBODY, NOBODY, NOBODY) };
}

/// Keeps each processor busy until it is dropped.
struct Busy(Arc<AtomicBool>);

impl Busy {
    fn everywhere(per_processor: usize) -> Self {
        let ends = Arc::new(AtomicBool::new(false));
        let count = available_parallelism().map_or(1, usize::from);
        for processor in (0..count).cycle().take(count * per_processor) {
            let ends = ends.clone();
            std::thread::spawn(move || {
                // SAFETY: the set is this thread's own, and valid for reading. Where it may not choose
                // its processor, the system spreads them.
                unsafe {
                    let mut set: libc::cpu_set_t = std::mem::zeroed();
                    libc::CPU_SET(processor, &mut set);
                    libc::sched_setaffinity(0, size_of_val(&set), &raw const set);
                }
                while !ends.load(Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        Self(ends)
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        self.0.store(true, Relaxed);
    }
}

/// A device that tells which thread reads it.
struct Named<D> {
    device: D,
    thread: Arc<AtomicI32>,
}

impl<D: Device> Device for Named<D> {
    fn read(&mut self, now: f64, dt: f64, frame: &DeviceFrame) -> Reading {
        if self.thread.load(Relaxed) == 0 {
            // SAFETY: touches no memory.
            self.thread.store(unsafe { libc::gettid() }, Relaxed);
        }
        self.device.read(now, dt, frame)
    }

    fn write(&mut self, force: DVec3, enable: bool, frame: &DeviceFrame) {
        self.device.write(force, enable, frame);
    }

    fn park(&mut self) {
        self.device.park();
    }

    fn report(&self) -> LinkReport {
        self.device.report()
    }
}

/// How often a thread has given up its processor by itself.
fn given_up(thread: &AtomicI32) -> u64 {
    let path = format!("/proc/self/task/{}/status", thread.load(Relaxed));
    let status = std::fs::read_to_string(path).expect("the thread runs");
    let line = status.lines().find(|l| l.starts_with("voluntary_ctxt_"));
    line.and_then(|l| l.split_whitespace().nth(1)?.parse().ok())
        .expect("a count")
}

#[test]
fn an_ordinary_users_servo_beside_busy_threads_waits_for_no_worker_of_the_kernel() {
    become_nobody();
    let (path, line) = terminal();
    let _line_up = line.try_clone().expect("a descriptor");
    let port = SerialPort { path, baud: None };
    let device = LinkDevice::open(Reopening::of(guarded(port)).expect("a thread")).expect("a port");
    let thread = Arc::new(AtomicI32::new(0));
    let named = Named {
        device,
        thread: thread.clone(),
    };
    let ends = Arc::new(AtomicBool::new(false));
    let boarding = std::thread::spawn({
        let ends = ends.clone();
        move || board(line, &ends)
    });
    let devices: Vec<Box<dyn Device>> = vec![Box::new(named)];
    let running = Running::start(bodies::elastic_cube(), devices, OPTIONS, settings(), 100, 0)
        .expect("a thread");
    let shot = || *running.published().first();
    while shot().link.states < 100 {
        sleep(Duration::from_millis(5));
    }
    let count = || {
        let sleeps = running.paced().timing().report().sleeps;
        (given_up(&thread), sleeps)
    };
    let busy = Busy::everywhere(2);
    let (before, tick) = (count(), shot().snapshot.tick);
    while shot().snapshot.tick < tick + 4000 {
        sleep(Duration::from_millis(20));
    }
    let after = count();
    drop(busy);
    ends.store(true, Relaxed);
    boarding.join().expect("the board ends");
    let (given_up, slept) = (after.0 - before.0, after.1 - before.1);
    assert!(slept > 100, "{slept}");
    // The two counts are not of the same moment.
    assert!(
        given_up <= slept + 3,
        "waited {given_up} times, slept {slept}"
    );
}
