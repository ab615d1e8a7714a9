//! Counts the system calls of one thread while it runs, each of them, by number.
//!
//! A seccomp filter on that thread alone hands every call that is not named as permitted to a
//! listener (`SECCOMP_RET_USER_NOTIF`, Linux 5.5), which counts it and lets it pass. No privilege
//! is needed.

use std::collections::BTreeMap;
use std::mem::zeroed;
use std::sync::atomic::{
    AtomicI32,
    Ordering::{Acquire, Release},
};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

/// Counts the calls of a thread that asked for it.
pub struct Counter {
    calls: Arc<Mutex<BTreeMap<i64, u64>>>,
    listener: Arc<AtomicI32>,
    counting: JoinHandle<()>,
}

/// What the thread to be watched needs.
pub struct Watch {
    listener: Arc<AtomicI32>,
    permitted: Vec<libc::c_long>,
    /// Requests to terminals that are permitted too.
    requests: Vec<libc::c_ulong>,
}

const NOT_YET: libc::c_int = -1;

const LOAD_NUMBER: u16 = (libc::BPF_LD | libc::BPF_W | libc::BPF_ABS) as u16;
const SKIP_UNLESS: u16 = (libc::BPF_JMP | libc::BPF_JEQ | libc::BPF_K) as u16;
const RETURN: u16 = (libc::BPF_RET | libc::BPF_K) as u16;

impl Counter {
    /// A counter for all calls but those that are permitted.
    pub fn new(permitted: &[libc::c_long], requests: &[libc::c_ulong]) -> (Self, Watch) {
        let calls = Arc::<Mutex<BTreeMap<i64, u64>>>::default();
        // No channel: the watched thread must be able to hand this over without any call.
        let listener = Arc::new(AtomicI32::new(NOT_YET));
        let counting = std::thread::spawn({
            let (calls, listener) = (calls.clone(), listener.clone());
            move || count(wait_for(&listener), &calls)
        });
        let counter = Self {
            calls,
            listener: listener.clone(),
            counting,
        };
        let (permitted, requests) = (permitted.to_vec(), requests.to_vec());
        (
            counter,
            Watch {
                listener,
                permitted,
                requests,
            },
        )
    }

    /// Waits until the thread is watched.
    pub fn wait(&self) {
        wait_for(&self.listener);
    }

    /// Calls so far, by number.
    pub fn calls(&self) -> BTreeMap<i64, u64> {
        self.calls.lock().expect("nobody panics").clone()
    }

    /// Waits until the watched thread has ended; all its calls, by number.
    pub fn finish(self) -> BTreeMap<i64, u64> {
        self.counting.join().expect("it ends with the thread");
        std::mem::take(&mut self.calls.lock().expect("nobody panics"))
    }
}

fn wait_for(listener: &AtomicI32) -> libc::c_int {
    loop {
        match listener.load(Acquire) {
            NOT_YET => std::thread::sleep(Duration::from_micros(100)),
            listener => return listener,
        }
    }
}

impl Watch {
    /// From here on the calling thread stops at each call until it has been counted.
    ///
    /// # Panics
    /// When the kernel cannot do this.
    pub fn begin(self) {
        let step = |code, jf, k| libc::sock_filter { code, jt: 0, jf, k };
        // The number of the call is the first field of what the filter looks at.
        let mut steps = vec![step(LOAD_NUMBER, 0, 0)];
        for &number in &self.permitted {
            steps.push(step(SKIP_UNLESS, 1, number as u32));
            steps.push(step(RETURN, 0, libc::SECCOMP_RET_ALLOW));
        }
        let requests = self.requests.len() as u8;
        if requests > 0 {
            // Of an ioctl the second argument: after the number, the machine and the place of the call.
            const REQUEST: u32 = 4 + 4 + 8 + 8;
            steps.push(step(SKIP_UNLESS, 2 * requests + 1, libc::SYS_ioctl as u32));
            steps.push(step(LOAD_NUMBER, 0, REQUEST));
            for &request in &self.requests {
                steps.push(step(SKIP_UNLESS, 1, request as u32));
                steps.push(step(RETURN, 0, libc::SECCOMP_RET_ALLOW));
            }
        }
        steps.push(step(RETURN, 0, libc::SECCOMP_RET_USER_NOTIF));
        let filter = libc::sock_fprog {
            len: steps.len() as u16,
            filter: steps.as_mut_ptr(),
        };
        // SAFETY: the filter is valid for reading; both calls concern this thread only.
        let listener = unsafe {
            libc::prctl(libc::PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
            libc::syscall(
                libc::SYS_seccomp,
                libc::SECCOMP_SET_MODE_FILTER,
                libc::SECCOMP_FILTER_FLAG_NEW_LISTENER,
                &raw const filter,
            )
        };
        assert!(listener >= 0, "{}", std::io::Error::last_os_error());
        self.listener.store(listener as libc::c_int, Release);
        // Freeing may give memory back to the system, which is no business of whoever is watched.
        std::mem::forget((self, steps));
    }
}

fn count(listener: libc::c_int, calls: &Mutex<BTreeMap<i64, u64>>) {
    loop {
        let mut ready = libc::pollfd {
            fd: listener,
            events: libc::POLLIN,
            revents: 0,
        };
        // SAFETY: one entry, valid for reading and writing.
        unsafe { libc::poll(&raw mut ready, 1, -1) };
        if ready.revents & libc::POLLIN == 0 {
            // The thread has ended.
            break;
        }
        // SAFETY: the kernel wants zeros, writes one and reads the other.
        unsafe {
            let mut call: libc::seccomp_notif = zeroed();
            if libc::ioctl(listener, libc::SECCOMP_IOCTL_NOTIF_RECV, &raw mut call) != 0 {
                continue;
            }
            *calls
                .lock()
                .expect("nobody panics")
                .entry(i64::from(call.data.nr))
                .or_default() += 1;
            let mut pass: libc::seccomp_notif_resp = zeroed();
            pass.id = call.id;
            pass.flags = libc::SECCOMP_USER_NOTIF_FLAG_CONTINUE as u32;
            libc::ioctl(listener, libc::SECCOMP_IOCTL_NOTIF_SEND, &raw mut pass);
        }
    }
    // SAFETY: the descriptor is this function's alone.
    unsafe { libc::close(listener) };
}
