//! An encoder that loses its place, with all that may hide it: none of it becomes a force.
//!
//! The servo's own ticks, the link's own bytes, virtual time. The device hovers 5 mm above a body; its
//! position jumps inwards, and from then on it says that it is inside. It never came in: no force.

use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::sync::{Arc, Mutex};

use crate::bodies;
use crate::bodies::Dice;
use crate::scripted::{OPTIONS, settings};
use glam::{DQuat, DVec3};
use palpate_servo::body::surface::Body;
use palpate_servo::control::safety::Limits;
use palpate_servo::device::Fault;
use palpate_servo::device::link::LinkDevice;
use palpate_servo::device::link::codec::{MAX_FRAME, encode};
use palpate_servo::device::serial::wire::{Opener, Wire};
use palpate_servo::servo::Servo;
use palpate_servo::servo::settings::Options;
use palpate_servo::servo::snapshot::{Published, Snapshot, State};
use triple_buffer::Output;

/// Of each kind; [`many`] has more of them.
const TRIES: usize = 60;
const HOVERING: f64 = 5e-3;
const RELEASED: Options = Options {
    limits: Limits {
        max_force: 3.0,
        max_slew: 1e9,
        ramp_seconds: 0.0,
    },
    ..OPTIONS
};

#[derive(Clone, Default)]
struct Memory(Arc<Mutex<VecDeque<u8>>>);

impl Wire for Memory {
    fn waiting(&mut self) -> io::Result<usize> {
        Ok(self.0.lock().unwrap().len())
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut stored = self.0.lock().unwrap();
        if stored.is_empty() {
            return Err(ErrorKind::WouldBlock.into());
        }
        let length = buffer.len().min(stored.len());
        for byte in &mut buffer[..length] {
            *byte = stored.pop_front().unwrap();
        }
        Ok(length)
    }

    /// Answers a HELLO, now and then asked for, at once.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if bytes == frame(&[1, 1]) {
            self.0.lock().unwrap().extend(frame(&hello()));
        }
        Ok(bytes.len())
    }
}

/// HELLO of a device of the first protocol.
fn hello() -> Vec<u8> {
    let mut hello = vec![1, 1];
    hello.extend([0; 16]);
    hello.push(3);
    hello.extend(3.0_f32.to_le_bytes());
    hello.extend([0; 14]);
    hello
}

impl Opener for Memory {
    type Wire = Self;

    fn open(&mut self) -> io::Result<Self> {
        Ok(self.clone())
    }
}

/// A device with its line, and the servo at the other end.
struct Run {
    servo: Servo,
    snapshots: Output<Published>,
    wire: Memory,
    /// Written, but not arrived: when it will, s.
    on_its_way: VecDeque<(f64, Vec<u8>)>,
    now: f64,
    made: f64,
    /// Of the device's clock against the true time, s.
    leap: f64,
    sequence: u16,
    period: f64,
    position: DVec3,
    is_turned: bool,
}

impl Run {
    fn new(body: Arc<Body>, period: f64, is_turned: bool) -> Self {
        let wire = Memory::default();
        let device = LinkDevice::open(wire.clone()).unwrap();
        let (servo, ends) = Servo::new(body, vec![Box::new(device)], RELEASED, &settings(), 1);
        let run = Self {
            servo,
            snapshots: ends.snapshots,
            wire,
            on_its_way: VecDeque::new(),
            now: 0.0,
            made: 0.0,
            leap: 0.0,
            sequence: 65_000,
            period,
            position: DVec3::ZERO,
            is_turned,
        };
        // A device of the first protocol is asked twice.
        run.arrive(&frame(&hello()));
        run.arrive(&frame(&hello()));
        run
    }

    fn arrive(&self, bytes: &[u8]) {
        self.wire.0.lock().unwrap().extend(bytes);
    }

    /// A STATE that was made now and comes at `arrival`, s.
    fn state(&mut self, arrival: f64) {
        let time_us = ((self.made + self.leap) * 1e6) as i64 as u32;
        let mut bytes = Vec::new();
        if self.is_turned {
            let turn = DQuat::from_rotation_x(0.3 * self.made);
            let mut payload = vec![5];
            payload.extend(self.sequence.to_le_bytes());
            for component in [turn.w, turn.x, turn.y, turn.z] {
                payload.extend(((component * 32_767.0).round() as i16).to_le_bytes());
            }
            bytes.extend(frame(&payload));
        }
        let mut payload = vec![2];
        payload.extend(self.sequence.to_le_bytes());
        payload.extend(time_us.to_le_bytes());
        for metres in self.position.to_array() {
            payload.extend(((metres * 1e6).round() as i32).to_le_bytes());
        }
        payload.extend([0, 1]);
        bytes.extend(frame(&payload));
        self.sequence = self.sequence.wrapping_add(1);
        let arrival = self.on_its_way.back().map_or(arrival, |b| b.0.max(arrival));
        self.on_its_way.push_back((arrival, bytes));
    }

    /// A tick `seconds` after the last one.
    fn tick(&mut self, seconds: f64, arrival: &mut dyn FnMut(f64) -> f64) -> Snapshot {
        self.now += seconds;
        while self.made + self.period <= self.now {
            self.made += self.period;
            let arrival = arrival(self.made);
            self.state(arrival);
        }
        while let Some((arrival, bytes)) = self.on_its_way.pop_front() {
            if arrival > self.now {
                self.on_its_way.push_front((arrival, bytes));
                break;
            }
            self.arrive(&bytes);
        }
        self.servo.tick(self.now);
        self.snapshots.read().first().snapshot
    }
}

fn frame(payload: &[u8]) -> Vec<u8> {
    let mut frame = [0; MAX_FRAME];
    let length = encode(payload, &mut frame).unwrap();
    frame[..length].to_vec()
}

/// How a message travels: when one that was made at this time arrives, s.
type Travel = fn(f64, &mut Dice) -> f64;

fn at_once(made: f64, _: &mut Dice) -> f64 {
    made
}

fn jittered(made: f64, dice: &mut Dice) -> f64 {
    made + dice.within(0.0, 2e-3)
}

/// Held back until a timer of 2 to 16 ms ends; one for each try, told by its first digits.
fn bursts<const MS: u32>(made: f64, _: &mut Dice) -> f64 {
    let timer = f64::from(MS) * 1e-3;
    (made / timer - 1e-9).ceil() * timer
}

const TRAVELS: [Travel; 6] = [
    bursts::<2>,
    bursts::<3>,
    bursts::<4>,
    bursts::<8>,
    bursts::<11>,
    bursts::<16>,
];

/// What hides the jump.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Hidden {
    InBursts,
    ByJitter,
    ByALeap,
    ByAPause,
    ByAHeldUpHost,
    InHalves,
}

/// A place 5 mm outside of a body, and the way inwards.
fn hover(body: &Body, dice: &mut Dice) -> (DVec3, DVec3) {
    let corners = body.triangles[dice.below(body.triangles.len())].map(|k| body.nodes[k as usize]);
    let [a, b, c] = corners;
    let (u, v) = (dice.within(0.2, 0.4), dice.within(0.2, 0.4));
    let place = a + (b - a) * u + (c - a) * v;
    let outwards = (b - a).cross(c - a).normalize();
    (place + outwards * HOVERING, -outwards)
}

/// One jump; the largest force and depth until long after it, N and the reading's name.
fn attempt(kind: Hidden, bodies: &[Arc<Body>], dice: &mut Dice) -> (f64, Snapshot) {
    let body = &bodies[dice.below(bodies.len())];
    let (place, inwards) = hover(body, dice);
    let period = [1e-3, 1e-3, 0.25e-3, 0.5e-3, 2e-3, 2.5e-3][dice.below(6)];
    let mut run = Run::new(body.clone(), period, dice.below(3) == 0);
    let travel: Travel = match kind {
        Hidden::InBursts => TRAVELS[dice.below(TRAVELS.len())],
        Hidden::ByJitter => jittered,
        _ => [at_once, jittered, bursts::<4>, bursts::<16>][dice.below(4)],
    };
    let tremor = dice.direction() * 2e-4;
    let settling = 100 + dice.below(40);
    let jitter = &mut Dice::new(dice.bits());
    for tick in 0..settling {
        run.position = place + tremor * (0.06 * tick as f64).sin();
        let shot = run.tick(1e-3, &mut |made| travel(made, jitter));
        assert_eq!(shot.output_force, DVec3::ZERO, "it hovers");
        assert!(tick < 60 || shot.state == State::Free, "{kind:?} {shot:?}");
    }
    let jump = inwards * dice.within(5e-3, 40e-3);
    let mut most: f64 = 0.0;
    let mut tick = |run: &mut Run, seconds| {
        let shot = run.tick(seconds, &mut |made| travel(made, jitter));
        most = most.max(shot.output_force.length());
        shot
    };
    let mut pause = 1e-3;
    match kind {
        Hidden::ByALeap => run.leap += [5e-3, 10e-3, 30e-3, 50e-3, 100e-3, 1.0][dice.below(6)],
        // Nothing is made, or nothing comes, for a while; or nobody looks.
        Hidden::ByAPause => {
            let ticks = 1 + dice.below(40);
            run.made += 1e-3 * ticks as f64;
            for _ in 0..ticks {
                tick(&mut run, 1e-3);
            }
        }
        Hidden::ByAHeldUpHost => pause = dice.within(1e-3, 60e-3),
        Hidden::InHalves => {
            run.position += jump * 0.5;
            tick(&mut run, 1e-3);
        }
        Hidden::InBursts | Hidden::ByJitter => {}
    }
    run.position += jump * if kind == Hidden::InHalves { 0.5 } else { 1.0 };
    let mut shot = tick(&mut run, pause);
    for _ in 0..180 {
        shot = tick(&mut run, 1e-3);
    }
    (most, shot)
}

/// Tries of a kind: how many were felt.
fn felt(kind: Hidden, tries: usize) -> Vec<f64> {
    let bodies = [
        bodies::cube(),
        bodies::sphere(0.03, 2),
        bodies::wall(0.03),
        bodies::turned(&bodies::cube(), 1.0),
    ];
    let mut dice = Dice::new(0x6A75_6D70 + kind as u64);
    let attempts = (0..tries).map(|_| attempt(kind, &bodies, &mut dice));
    attempts
        .map(|(most, shot)| {
            assert_ne!(shot.fault, Some(Fault::Nan));
            most
        })
        .filter(|most| *most > 0.0)
        .collect()
}

fn none_is_felt(kind: Hidden) {
    let felt = felt(kind, TRIES);
    assert!(
        felt.is_empty(),
        "{kind:?}: {} of {TRIES}, {felt:?}",
        felt.len()
    );
}

#[test]
fn no_jump_in_a_burst_is_felt() {
    none_is_felt(Hidden::InBursts);
}

#[test]
fn no_jump_under_jitter_is_felt() {
    none_is_felt(Hidden::ByJitter);
}

#[test]
fn no_jump_with_a_leap_of_the_devices_clock_is_felt() {
    none_is_felt(Hidden::ByALeap);
}

#[test]
fn no_jump_during_a_pause_is_felt() {
    none_is_felt(Hidden::ByAPause);
}

#[test]
fn no_jump_while_the_host_was_held_up_is_felt() {
    none_is_felt(Hidden::ByAHeldUpHost);
}

#[test]
fn no_jump_in_two_halves_is_felt() {
    none_is_felt(Hidden::InHalves);
}

#[test]
#[ignore = "minutes: 10,000 of each kind"]
fn many() {
    use Hidden::{ByAHeldUpHost, ByALeap, ByAPause, ByJitter, InBursts, InHalves};
    for kind in [
        InBursts,
        ByJitter,
        ByALeap,
        ByAPause,
        ByAHeldUpHost,
        InHalves,
    ] {
        let felt = felt(kind, 10_000);
        let most = felt.iter().copied().fold(0.0, f64::max);
        println!(
            "{kind:?}: {} of 10,000 felt, {most:.2} N at most",
            felt.len()
        );
    }
}
