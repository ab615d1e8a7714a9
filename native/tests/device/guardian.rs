//! A guardian whose host lives on, but has left the device without letting it go.

use std::io::Read;
use std::os::unix::net::UnixStream;
use std::time::Duration;

use palpate_servo::guardian::Guardian;

#[test]
fn whoever_leaves_a_device_without_letting_it_go_has_the_last_word_said() {
    let (port, mut device) = UnixStream::pair().unwrap();
    let mut guardian = Guardian::of(&port).unwrap();
    for _ in 0..5 {
        guardian.live(b"zero");
        std::thread::sleep(Duration::from_millis(1));
    }
    drop(guardian);
    drop(port);
    let mut heard = String::new();
    device.read_to_string(&mut heard).unwrap();
    assert!(heard.ends_with("zerozerozero"), "{heard}");
}

#[test]
fn a_guardian_that_is_held_up_for_half_a_second_still_says_it() {
    let (port, mut device) = UnixStream::pair().unwrap();
    let mut guardian = Guardian::of(&port).unwrap();
    guardian.live(b"zero");
    let process = guardian.process().unwrap() as libc::pid_t;
    // SAFETY: a signal to a child that has not been waited for.
    let send = move |signal| assert_eq!(unsafe { libc::kill(process, signal) }, 0);
    send(libc::SIGSTOP);
    let waker = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(500));
        send(libc::SIGCONT);
    });
    drop(guardian);
    drop(port);
    waker.join().unwrap();
    let mut heard = String::new();
    device.read_to_string(&mut heard).unwrap();
    assert!(heard.ends_with("zerozerozero"), "{heard}");
}
