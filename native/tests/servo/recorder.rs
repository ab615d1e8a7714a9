//! The recording of every tick, over ten minutes of virtual time and at its limits.

use std::time::Duration;

use glam::DVec3;
use palpate_servo::control::safety::Limits;
use palpate_servo::device::pointer::{Pointer, Target};
use palpate_servo::servo::Servo;
use palpate_servo::servo::recorder::{RING_SECONDS, Recorder, Tape};
use palpate_servo::servo::settings::{Options, Settings};
use palpate_servo::servo::snapshot::{Sample, State};
use palpate_servo::servo::thread::Running;
use triple_buffer::triple_buffer;

const OPTIONS: Options = Options {
    rate_hz: 1000,
    limits: Limits {
        max_force: 3.0,
        max_slew: 1000.0,
        ramp_seconds: 0.1,
    },
    max_speed: 2.0,
};

fn settings() -> Settings {
    Settings::new(1e4)
}

fn sample(tick: u64) -> Sample {
    Sample {
        tick,
        time: tick as f64 * 1e-3,
        ..Sample::default()
    }
}

fn recorded(recorder: &Recorder) -> Vec<Sample> {
    recorder.read(|pieces| pieces.concat())
}

fn ticks(recorder: &Recorder) -> Vec<u64> {
    recorded(recorder).iter().map(|s| s.tick).collect()
}

fn put_all(tape: &mut Tape, range: std::ops::Range<u64>) {
    range.for_each(|tick| tape.put(sample(tick)));
}

/// Waits for the recorder's own thread; nothing else empties the ring.
fn wait_for(recorder: &Recorder, count: usize) {
    for _ in 0..5_000 {
        if recorder.count() >= count {
            return;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("{} of {count} ticks recorded", recorder.count());
}

#[test]
fn ten_minutes_at_1_khz_lose_no_tick_while_pressing() {
    const TICKS: u64 = 600_000;
    let start = Target::first(DVec3::new(0.02, 0.03, 0.055));
    let (mut targets_in, targets) = triple_buffer(&start);
    let pointer = Box::new(Pointer::new(start, targets, 0.5));
    let body = crate::bodies::cube();
    let (mut servo, mut ends) = Servo::new(body, vec![pointer], OPTIONS, &settings(), 1000);
    let ring = RING_SECONDS as usize * 1000;
    let (tape, recorder) = Recorder::new(ring);
    servo.tape = Some(tape);
    recorder.start(TICKS as usize).unwrap();
    let mut target = start;
    let mut beside = 0;
    for tick in 1..=TICKS {
        if tick % 17 == 0 {
            let height = 0.047 + 0.006 * (tick as f64 * 1e-3).sin();
            target = target.next(DVec3::new(0.02, 0.03, height), false);
            targets_in.write(target);
        }
        servo.tick(tick as f64 * 1e-3);
        if tick % 1000 == 0 {
            // `samples()` takes every tick too, from a ring of its own.
            beside += std::iter::from_fn(|| ends.samples.pop().ok()).count() as u64;
        }
        if tick % (ring as u64 / 2) == 0 {
            // Time goes by faster here than the recorder's pauses allow for.
            wait_for(&recorder, tick as usize - ring / 4);
        }
    }
    recorder.stop();
    let all = recorded(&recorder);
    assert_eq!((recorder.lost(), all.len() as u64), (0, TICKS));
    assert_eq!(ends.snapshots.read().samples_lost, 0);
    assert_eq!(beside, TICKS);
    let mut touching = 0;
    for (number, sample) in (1..).zip(&all) {
        assert_eq!((sample.tick, sample.time), (number, number as f64 * 1e-3));
        let presses = sample.force != [0.0; 3];
        if sample.state == State::Touching as u32 {
            touching += 1;
            assert!(presses);
        }
        let moved = DVec3::from(sample.probe).distance(DVec3::from(sample.proxy));
        assert_eq!(moved > 0.0, presses, "tick {number}");
    }
    assert!((100_000..500_000).contains(&touching), "{touching}");
}

#[test]
fn it_ends_by_itself_after_as_many_ticks_as_asked() {
    let (mut tape, recorder) = Recorder::new(1000);
    recorder.start(100).unwrap();
    put_all(&mut tape, 0..250);
    wait_for(&recorder, 100);
    // What it was not asked for is no loss.
    assert_eq!((ticks(&recorder), recorder.lost()), ((0..100).collect(), 0));
    assert!(!recorder.is_on());
    put_all(&mut tape, 250..300);
    assert_eq!(recorded(&recorder).len(), 100);
}

#[test]
fn a_full_ring_is_a_loss_that_is_counted_and_the_rest_stays_in_order() {
    let (mut tape, recorder) = Recorder::new(50);
    recorder.start(1000).unwrap();
    // Whoever reads holds the store, so that the recorder's thread cannot empty the ring.
    recorder.read(|_| put_all(&mut tape, 0..120));
    assert_eq!((ticks(&recorder), recorder.lost()), ((0..50).collect(), 70));
    put_all(&mut tape, 120..130);
    recorder.stop();
    let expected: Vec<u64> = (0..50).chain(120..130).collect();
    assert_eq!((ticks(&recorder), recorder.lost()), (expected, 70));
}

#[test]
fn a_new_recording_holds_nothing_of_the_one_before() {
    let (mut tape, recorder) = Recorder::new(10);
    put_all(&mut tape, 0..5);
    assert!(!recorder.is_on() && recorded(&recorder).is_empty());
    recorder.start(100).unwrap();
    recorder.read(|_| put_all(&mut tape, 5..25));
    recorder.stop();
    put_all(&mut tape, 25..30);
    assert_eq!((recorded(&recorder).len(), recorder.lost()), (10, 10));
    recorder.start(100).unwrap();
    put_all(&mut tape, 30..33);
    recorder.stop();
    assert_eq!((ticks(&recorder), recorder.lost()), (vec![30, 31, 32], 0));
}

#[test]
fn a_running_servo_records_from_its_first_tick() {
    let start = Target::first(DVec3::new(0.02, 0.03, 0.055));
    let (_targets_in, targets) = triple_buffer(&start);
    let pointer = Pointer::new(start, targets, 0.5);
    let running = Running::start(
        crate::bodies::cube(),
        vec![Box::new(pointer)],
        OPTIONS,
        settings(),
        10,
        50,
    )
    .unwrap();
    wait_for(running.recorder(), 50);
    assert_eq!(ticks(running.recorder()), (1..=50).collect::<Vec<_>>());
    // The ring of `samples()` is smaller, and nobody has emptied it.
    running.paced().stop();
    assert_eq!(running.drain().len(), 10);
    assert!(running.published().samples_lost >= 40);
}
