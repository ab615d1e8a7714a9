//! The servo's thread waits for nobody: its system calls are counted while others do their worst.
#![cfg(target_os = "linux")]

#[path = "../bodies/mod.rs"]
mod bodies;
mod starved;
mod system_calls;

use std::collections::BTreeMap;
use std::ffi::CStr;
use std::fs::File;
use std::io::{Read, Write};
use std::os::fd::{FromRawFd, OwnedFd};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::thread::{scope, sleep};
use std::time::Duration;

use glam::{DMat3, DVec3};
use palpate_servo::control::safety::Limits;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::link::codec::{Decoder, MAX_FRAME, encode};
use palpate_servo::device::serial::guarded::GuardedPort;
use palpate_servo::device::serial::port::SerialPort;
use palpate_servo::device::serial::reopening::Reopening;
use palpate_servo::device::{Device, DeviceFrame, Fault, LinkReport, Probe, Reading};
use palpate_servo::servo::settings::{Options, Settings};
use palpate_servo::servo::stages::Stage;
use palpate_servo::servo::thread::Running;
use system_calls::{Counter, Watch};

const OPTIONS: Options = Options {
    rate_hz: 2000,
    limits: Limits {
        max_force: 3.0,
        max_slew: 1000.0,
        ramp_seconds: 0.01,
    },
    max_speed: 10.0,
};

fn settings() -> Settings {
    Settings::new(1e4)
}

/// The sleep, and the clock where the kernel does not let it be read without a call.
const PACE: [libc::c_long; 2] = [libc::SYS_clock_nanosleep, libc::SYS_clock_gettime];

/// What a terminal is asked: how much has come, and how much has not left. Neither waits for anybody;
/// what throws away (TCFLSH) does.
const QUESTIONS: [libc::c_ulong; 2] = [libc::FIONREAD, libc::TIOCOUTQ];

/// Of a serial port with its guardian: whether that has ended is a wait that does not wait.
const PORT: [libc::c_long; 3] = [libc::SYS_read, libc::SYS_write, libc::SYS_wait4];

/// A device that has its thread watched from the first tick on.
struct Watching<D> {
    device: D,
    watch: Option<Watch>,
}

impl<D: Device> Device for Watching<D> {
    fn read(&mut self, now: f64, dt: f64, frame: &DeviceFrame) -> Reading {
        if let Some(watch) = self.watch.take() {
            watch.begin();
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

/// Everything that callers can do, again and again, until the servo has done its ticks.
fn hammer(running: &Running, ticks: u64) {
    let enough = AtomicBool::new(false);
    let until_enough = |work: &dyn Fn()| {
        while !enough.load(Relaxed) {
            work();
        }
    };
    let recorder = running.recorder();
    scope(|others| {
        others.spawn(|| {
            until_enough(&|| {
                running.published();
            })
        });
        others.spawn(|| {
            until_enough(&|| {
                running.drain();
                running.paced().timing().report();
                running.stages().report(Stage::Contact);
                running.paced().realtime();
            });
        });
        others.spawn(|| {
            until_enough(&|| {
                running.set(Settings {
                    young_modulus: 2e4,
                    ..settings()
                });
            });
        });
        others.spawn(|| {
            until_enough(&|| {
                running.set_body(bodies::elastic_cube(), settings());
                // Time to come out of the old body and into the new one.
                sleep(Duration::from_millis(150));
            });
        });
        others.spawn(|| {
            until_enough(&|| {
                recorder.start(500).expect("a thread");
                // A reader that stalls, with all that it holds.
                recorder.read(|_| sleep(Duration::from_millis(20)));
            });
        });
        let from = running.published().first().snapshot.tick;
        while running.published().first().snapshot.tick < from + ticks {
            assert!(running.paced().is_running(), "the servo has ended");
            sleep(Duration::from_millis(5));
        }
        enough.store(true, Relaxed);
    });
}

/// Calls that were not permitted while the servo was hammered upon, by number.
fn calls_of<D: Device + 'static>(
    device: D,
    others: Vec<Box<dyn Device>>,
    permitted: &[libc::c_long],
    during: impl FnOnce(&Running),
) -> BTreeMap<i64, u64> {
    let (counter, watch) = Counter::new(&[&PACE, permitted].concat(), &QUESTIONS);
    let watching = Watching {
        device,
        watch: Some(watch),
    };
    let mut devices: Vec<Box<dyn Device>> = vec![Box::new(watching)];
    devices.extend(others);
    let running = Running::start(bodies::elastic_cube(), devices, OPTIONS, settings(), 100, 0)
        .expect("a thread");
    counter.wait();
    during(&running);
    let calls = counter.calls();
    running.paced().stop();
    let with_its_end = counter.finish();
    assert!(
        with_its_end.len() > calls.len(),
        "the end of a thread takes calls: nothing was seen"
    );
    calls
}

/// A hand that goes into the body and out again ten times a second: a body that is exchanged is
/// not felt before the probe was outside once.
struct Dipping {
    touched: Arc<AtomicU64>,
}

impl Device for Dipping {
    fn read(&mut self, now: f64, _dt: f64, _frame: &DeviceFrame) -> Reading {
        Reading::At(Probe {
            position: DVec3::new(0.02, 0.02, 0.05 + 0.005 * (now * 62.8).cos()),
            orientation: DMat3::IDENTITY,
            speed: 0.1,
            restart: false,
            buttons: 0,
            max_force: 3.0,
        })
    }

    fn write(&mut self, force: DVec3, _enable: bool, _frame: &DeviceFrame) {
        if force != DVec3::ZERO {
            self.touched.fetch_add(1, Relaxed);
        }
    }

    fn park(&mut self) {}
}

#[test]
fn a_servo_only_sleeps() {
    let touched = Arc::new(AtomicU64::new(0));
    let dipping = Dipping {
        touched: touched.clone(),
    };
    let calls = calls_of(dipping, Vec::new(), &[], |running| hammer(running, 3000));
    assert_eq!(calls, BTreeMap::new());
    assert!(touched.load(Relaxed) > 100, "{touched:?}");
}

#[test]
fn a_servo_with_two_fingers_that_feel_each_other_only_sleeps() {
    let touched = [Arc::new(AtomicU64::new(0)), Arc::new(AtomicU64::new(0))];
    let [first, second] = touched.clone().map(|touched| Dipping { touched });
    let calls = calls_of(first, vec![Box::new(second)], &[], |running| {
        hammer(running, 3000);
        assert_eq!(running.published().fingers().len(), 2);
    });
    assert_eq!(calls, BTreeMap::new());
    assert!(
        touched.iter().all(|touched| touched.load(Relaxed) > 100),
        "{touched:?}"
    );
}

/// A pseudo-terminal: the host's path, and the device's end.
fn terminal() -> (String, File) {
    let mut name = [0; 128];
    // SAFETY: the calls are given an open descriptor and memory of the length they are told.
    let controlling = unsafe {
        let fd = libc::posix_openpt(libc::O_RDWR | libc::O_NOCTTY | libc::O_CLOEXEC);
        assert!(fd >= 0 && libc::grantpt(fd) == 0 && libc::unlockpt(fd) == 0);
        assert_eq!(libc::ptsname_r(fd, name.as_mut_ptr(), name.len()), 0);
        File::from(OwnedFd::from_raw_fd(fd))
    };
    // SAFETY: ptsname_r ended the name with a zero byte.
    let name = unsafe { CStr::from_ptr(name.as_ptr()) };
    (name.to_str().expect("a path").to_owned(), controlling)
}

/// A board that greets once it is spoken to, and then stands in the body.
fn board(mut line: File, ends: &AtomicBool) {
    let mut frame = [0; MAX_FRAME];
    let mut say = |line: &mut File, payload: &[u8]| {
        let length = encode(payload, &mut frame).expect("it fits");
        line.write_all(&frame[..length]).expect("the host is there");
    };
    let mut heard = [0; 1024];
    assert!(line.read(&mut heard).expect("HELLO") > 0);
    let mut greeting = [0; 39];
    greeting[..2].copy_from_slice(&[1, 2]);
    greeting[18] = 3;
    greeting[19..23].copy_from_slice(&2.5_f32.to_le_bytes());
    say(&mut line, &greeting);
    let mut state = [0; 23];
    (state[0], state[20]) = (2, 1);
    let mut ears = Decoder::default();
    for tick in 0_u32.. {
        if ends.load(Relaxed) {
            break;
        }
        state[1..3].copy_from_slice(&(tick as u16).to_le_bytes());
        state[3..7].copy_from_slice(&(tick * 1000).to_le_bytes());
        let height = 60_000_i32.saturating_sub(tick as i32 * 10).max(47_000);
        for (place, um) in [(7, 20_000), (11, 20_000), (15, height)] {
            state[place..place + 4].copy_from_slice(&i32::to_le_bytes(um));
        }
        say(&mut line, &state);
        // The servo answers each state, so there is always something to read.
        let count = line.read(&mut heard).expect("the host is there");
        for &byte in &heard[..count] {
            if let Some(&[3, low, high, ..]) = ears.push(byte) {
                state[20] = 5;
                state[21..].copy_from_slice(&[low, high]);
            }
        }
    }
}

fn guarded(port: SerialPort) -> GuardedPort {
    GuardedPort {
        port,
        needs_guardian: true,
    }
}

#[test]
fn a_servo_with_a_serial_device_only_sleeps_reads_and_writes() {
    let (path, line) = terminal();
    // Keeps the line up after the board has ended: a port that hangs up is closed, with calls.
    let _line_up = line.try_clone().expect("a descriptor");
    let port = SerialPort { path, baud: None };
    let device = LinkDevice::open(Reopening::of(guarded(port)).expect("a thread")).expect("a port");
    let ends = Arc::new(AtomicBool::new(false));
    let boarding = std::thread::spawn({
        let ends = ends.clone();
        move || board(line, &ends)
    });
    let calls = calls_of(device, Vec::new(), &PORT, |running| {
        hammer(running, 3000);
        let seen = running.published();
        assert!(
            seen.first().link.states > 100 && seen.first().link.reopened == 0,
            "{:?}",
            seen.first().link
        );
        ends.store(true, Relaxed);
        boarding.join().expect("the board ends");
    });
    assert_eq!(calls, BTreeMap::new());
}

#[test]
fn a_port_that_goes_is_closed_and_opened_again_by_another_thread() {
    let (gone, line) = terminal();
    let path = std::env::temp_dir().join(format!("palpate-port-{}", std::process::id()));
    let lead_to = |terminal: &str| {
        let _ = std::fs::remove_file(&path);
        std::os::unix::fs::symlink(terminal, &path).expect("a link");
    };
    lead_to(&gone);
    let port = SerialPort {
        path: path.to_str().expect("a path").to_owned(),
        baud: None,
    };
    let device = LinkDevice::open(Reopening::of(guarded(port)).expect("a thread")).expect("a port");
    // Wakes the other thread.
    let permitted = [&PORT, &[libc::SYS_futex][..]].concat();
    let calls = calls_of(device, Vec::new(), &permitted, |running| {
        let comes = |what: &dyn Fn(&LinkReport, Option<Fault>) -> bool| {
            for _ in 0..2000 {
                let first = *running.published().first();
                if what(&first.link, first.snapshot.fault) {
                    return;
                }
                sleep(Duration::from_millis(5));
            }
            panic!("{:?}", running.published().first());
        };
        drop(line);
        comes(&|_, fault| fault == Some(Fault::Unplugged));
        // Time to try in vain.
        sleep(Duration::from_millis(500));
        let (back, _line) = terminal();
        lead_to(&back);
        comes(&|link, _| link.reopened == 1);
        let hellos = running.published().first().link.hellos;
        comes(&|link, _| link.hellos > hellos);
    });
    std::fs::remove_file(&path).expect("the link");
    assert_eq!(calls, BTreeMap::new());
}

/// A device that does what no device may: it takes a lock that others hold for a long time.
struct Locking(Arc<Mutex<Dipping>>);

impl Device for Locking {
    fn read(&mut self, now: f64, dt: f64, frame: &DeviceFrame) -> Reading {
        self.0.lock().expect("nobody panics").read(now, dt, frame)
    }

    fn write(&mut self, _force: DVec3, _enable: bool, _frame: &DeviceFrame) {}

    fn park(&mut self) {}
}

#[test]
fn the_counter_sees_a_lock_that_others_hold() {
    let shared = Arc::new(Mutex::new(Dipping {
        touched: Arc::default(),
    }));
    let calls = calls_of(Locking(shared.clone()), Vec::new(), &[], |running| {
        for _ in 0..20 {
            let held = shared.lock().expect("nobody panics");
            sleep(Duration::from_millis(5));
            drop(held);
            sleep(Duration::from_millis(1));
        }
        assert!(running.paced().is_running());
    });
    assert!(calls[&libc::SYS_futex] >= 5, "{calls:?}");
    assert_eq!(calls.len(), 1, "{calls:?}");
}
