//! The tick allocates nothing: counted over 100,000 of them, with a device on a wire.

use std::sync::Arc;

use crate::circling::InMemory;
use crate::counting::counted;
use glam::DVec3;
use palpate_servo::clock::timing::{Pace, Timing, Waking};
use palpate_servo::contact::cones::MAX_FINGERS;
use palpate_servo::control::safety::Limits;
use palpate_servo::creep::relaxation::Creep;
use palpate_servo::creep::term::Term;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::pointer::{Pointer, Target};
use palpate_servo::device::{Device, DeviceFrame, Fault, LinkReport, Probe, Reading};
use palpate_servo::servo::Servo;
use palpate_servo::servo::recorder::Recorder;
use palpate_servo::servo::settings::{Options, Settings};
use palpate_servo::servo::snapshot::{Published, State};
use palpate_servo::servo::stages::Stage;
use triple_buffer::triple_buffer;

const OPTIONS: Options = Options {
    rate_hz: 1000,
    limits: Limits {
        max_force: 3.0,
        max_slew: 1000.0,
        ramp_seconds: 0.1,
    },
    max_speed: 10.0,
};

fn settings() -> Settings {
    Settings::new(1e4)
}

/// A body that gives way with time.
fn giving_way() -> Creep {
    let terms = [Term {
        share: 1.0,
        seconds: 0.05,
    }];
    Creep::of(&terms).expect("a series")
}

/// Settings as a user changes them, other ones at each tick.
fn changed(tick: u32, creep: &Creep) -> Settings {
    let mut changed = settings();
    changed.young_modulus *= f64::from(1 + tick % 5);
    changed.feel.shading = tick % 2 == 0;
    changed.feel.static_friction = 0.1 * f64::from(tick % 3);
    changed.fingers[0].coupling.passivity_control = tick % 7 == 0;
    if tick / 300 % 2 == 0 {
        changed.creep = *creep;
    }
    changed.enabled = tick % 1000 > 10;
    changed.fingers[0].frame.epoch = tick / 5000;
    changed
}

fn ticks_of<D: Device + 'static>(device: D, mut each: impl FnMut(u32)) -> (Published, u64) {
    const TICKS: u32 = 100_000;
    // Full long before the end, and emptied by a thread that allocates on its own account.
    let (tape, recorder) = Recorder::new(1000);
    recorder.start(TICKS as usize / 2).expect("a thread");
    let body = crate::bodies::giving_cube();
    // Smaller than the run: a full ring must not allocate either.
    let (mut servo, mut ends) =
        Servo::new(body, vec![Box::new(device)], OPTIONS, &settings(), 50_000);
    servo.tape = Some(tape);
    let creep = giving_way();
    let ((), allocations) = counted(|| {
        for tick in 1..=TICKS {
            each(tick);
            if tick % 3 == 0 {
                ends.settings.write(changed(tick, &creep));
            }
            servo.tick(f64::from(tick) * 1e-3);
        }
    });
    recorder.stop();
    assert!(recorder.count() >= 1000 && recorder.lost() > 0);
    for stage in Stage::ALL {
        assert_eq!(servo.stages().report(stage).count, u64::from(TICKS));
    }
    (*ends.snapshots.read(), allocations)
}

#[test]
fn the_counter_counts() {
    assert!(counted(|| drop(std::hint::black_box(Box::new(1)))).1 >= 2);
}

#[test]
fn waking_and_counting_allocate_nothing() {
    let timing = Timing::default();
    let mut pace = Pace::new(8000, Waking::BusyWait);
    let mut woken = 0.0;
    assert_eq!(
        counted(|| (0..200).for_each(|_| woken = pace.wait(&timing, || true).unwrap().seconds)).1,
        0
    );
    assert!(woken > 0.02);
    assert_eq!(timing.report().ticks(), 200);
}

#[test]
fn a_hundred_thousand_ticks_with_a_device_allocate_nothing() {
    let device = LinkDevice::open(InMemory).expect("memory opens");
    let (last, allocations) = ticks_of(device, |_| {});
    assert_eq!(allocations, 0);
    assert_eq!(last.first().snapshot.tick, 100_000);
    assert!(last.first().link.states > 45_000, "{:?}", last.first().link);
    assert!(last.first().link.forces > 45_000);
    assert!(last.first().link.orientations > 40_000);
    assert!(last.first().link.orientations_refused > 1000);
    assert!(last.first().link.orientations_unpaired > 1000);
    assert!(
        last.first().link.crc_errors > 100 && last.first().link.oversize > 50,
        "{:?}",
        last.first().link
    );
    assert_eq!(last.samples_lost, 50_000);
    assert_eq!(last.first().faults, [0; Fault::ALL.len()]);
}

#[test]
fn a_hundred_thousand_ticks_with_a_pointer_allocate_nothing() {
    let start = Target::first(DVec3::new(0.02, 0.02, 0.06));
    let mut target = start;
    let (mut targets_in, targets) = triple_buffer(&start);
    let mut touching = 0;
    let pointer = Pointer::new(start, targets, 0.5);
    let (last, allocations) = ticks_of(pointer, |tick| {
        if tick % 17 == 0 {
            let t = f64::from(tick) * 1e-3;
            touching += 1;
            let position = DVec3::new(
                0.025 + 0.03 * t.cos(),
                0.025 + 0.03 * (0.7 * t).sin(),
                0.05 - 0.015 * (3.0 * t).sin(),
            );
            target = target.next(position, tick % 20_000 == 0);
            targets_in.write(target);
        }
    });
    assert_eq!(allocations, 0);
    assert!(touching > 5_000);
    assert!(matches!(
        last.first().snapshot.state,
        State::Free | State::Touching
    ));
    assert!(last.first().most_steps >= 2);
}

#[test]
fn a_body_is_exchanged_without_allocating_or_freeing_in_the_tick() {
    let start = Target::first(DVec3::new(0.02, 0.02, 0.045));
    let (_targets_in, targets) = triple_buffer(&start);
    let first = crate::bodies::cube();
    let mut old = Arc::downgrade(&first);
    let pointer = Box::new(Pointer::new(start, targets, 0.5));
    let (mut servo, ends) = Servo::new(first, vec![pointer], OPTIONS, &settings(), 50_000);
    let (mut hand, mut snapshots) = (ends.bodies, ends.snapshots);
    let mut now = 0.0;
    let mut tick = || {
        now += 1e-3;
        assert_eq!(counted(|| servo.tick(now)).1, 0);
        snapshots.read().first().snapshot.body
    };
    for round in 1..=100 {
        let body = crate::bodies::giving_cube();
        let new = Arc::downgrade(&body);
        let number = hand.give(body);
        assert_eq!((number, tick()), (round, round));
        hand.settle();
        tick();
        assert_eq!(old.strong_count(), 1, "its last holder is out of the tick");
        assert!(counted(|| hand.forget_older()).1 > 0);
        assert_eq!(old.strong_count(), 0);
        tick();
        old = new;
    }
}

/// A finger that circles over the body, in and out, by itself.
struct Drumming {
    tick: u32,
    phase: f64,
}

impl Device for Drumming {
    fn read(&mut self, _now: f64, _dt: f64, _frame: &DeviceFrame) -> Reading {
        self.tick += 1;
        if self.tick % 999 == 0 {
            return Reading::Fault(Fault::Stale);
        }
        let t = f64::from(self.tick) * 1e-3 + self.phase;
        let around = DVec3::new(0.02 * (2.0 * t).cos(), 0.02 * (2.7 * t).sin(), 0.0);
        Reading::At(Probe {
            position: DVec3::new(0.025, 0.025, 0.049 - 0.003 * (9.0 * t).sin()) + around,
            orientation: glam::DMat3::IDENTITY,
            speed: 0.1,
            restart: self.tick % 5_000 == 1,
            buttons: 0,
            max_force: 3.0,
        })
    }

    fn write(&mut self, _force: DVec3, _enable: bool, _frame: &DeviceFrame) {}

    fn park(&mut self) {}

    fn report(&self) -> LinkReport {
        LinkReport::default()
    }
}

#[test]
fn five_fingers_that_feel_each_other_allocate_nothing() {
    let devices = (0..MAX_FINGERS).map(|k| -> Box<dyn Device> {
        Box::new(Drumming {
            tick: 0,
            phase: 1.3 * k as f64,
        })
    });
    let body = crate::bodies::elastic_cube();
    let (mut servo, mut ends) = Servo::new(body, devices.collect(), OPTIONS, &settings(), 50_000);
    let mut together = 0;
    let creep = giving_way();
    let ((), allocations) = counted(|| {
        for tick in 1..=20_000 {
            if tick % 3 == 0 {
                ends.settings.write(changed(tick, &creep));
            }
            servo.tick(f64::from(tick) * 1e-3);
            let told = ends.snapshots.read().fingers();
            let touching = told.iter().filter(|told| told.snapshot.hold.is_some());
            together += u32::from(touching.count() > 2);
        }
    });
    assert_eq!(allocations, 0);
    assert!(together > 3_000, "{together}");
    let last = ends.snapshots.read();
    assert!(
        last.fingers()
            .iter()
            .all(|told| told.faults[Fault::Stale as usize] == 20)
    );
    assert!(
        last.fingers()
            .iter()
            .all(|told| told.faults[Fault::Nan as usize] == 0)
    );
}
