//! Bytes lost, added and damaged on a line without frames: no wrong force stays, all recovers.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use crate::haply::board::Cable;
use glam::DVec3;
use palpate_servo::device::haply::device::{Calibration, HaplyDevice};
use palpate_servo::device::haply::model::{MODELS, Model};
use palpate_servo::device::reason;
use palpate_servo::device::{Device, DeviceFrame, Reading};

const TICK: f64 = 1e-3;
const MODEL: &Model = &MODELS[0];
/// Requests that may just be obeyed, counted from the newest.
const LATE_REQUESTS: usize = 8;
/// Ticks that a torque may be another than asked for.
const WRONG_TICKS: u32 = 2;

/// Small, even and the same everywhere: xorshift.
struct Dice(u64);

impl Dice {
    fn below(&mut self, sides: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % sides
    }

    /// Loses, adds or damages one of these bytes; which of the three.
    fn hurt(&mut self, bytes: &mut VecDeque<u8>) -> usize {
        let place = self.below(bytes.len().max(1) as u64) as usize;
        // Half of what is added is a command.
        let byte = [self.below(256), self.below(3)][self.below(2) as usize] as u8;
        let kind = self.below(3) as usize;
        match kind {
            0 => _ = bytes.remove(place),
            1 => bytes.insert(place, byte),
            _ if bytes.is_empty() => {}
            _ => bytes[place] ^= 1 << self.below(8),
        }
        kind
    }
}

/// Arms that go to and fro, a force that turns round and round, a line that fails when told to.
struct Run {
    cable: Cable,
    device: HaplyDevice<Cable>,
    tick: u32,
    reading: Reading,
    /// How far the position is from the truth, m.
    off: f64,
    farthest_off: f64,
    wrong: u32,
    longest_wrong: u32,
}

impl Run {
    fn new() -> Self {
        let cable = Cable::default();
        let calibration = Calibration {
            degrees: MODEL.rest_degrees(),
            always: false,
        };
        let device = HaplyDevice::open(cable.clone(), MODEL, calibration).unwrap();
        let mut run = Self {
            cable,
            device,
            tick: 0,
            reading: Reading::Waiting(""),
            off: 0.0,
            farthest_off: 0.0,
            wrong: 0,
            longest_wrong: 0,
        };
        run.clean_ticks(40);
        assert!(matches!(run.reading, Reading::At(_)));
        run
    }

    fn clean_ticks(&mut self, count: u32) {
        (0..count).for_each(|_| self.step(&mut |_| (), &mut |_| ()));
    }

    fn step(
        &mut self,
        to_board: &mut dyn FnMut(&mut VecDeque<u8>),
        to_host: &mut dyn FnMut(&mut VecDeque<u8>),
    ) {
        self.tick += 1;
        let now = f64::from(self.tick) * TICK;
        // The handle stays at rest until the board has been set up, as its user should.
        let swing = (150.0 * (1.0 - (3.0 * (now - 0.04).max(0.0)).cos())) as i64;
        let frame = DeviceFrame::default();
        self.reading = self.device.read(now, TICK, &frame);
        if let Reading::At(probe) = self.reading {
            self.off = probe.position.distance(self.place(swing));
            self.farthest_off = self.farthest_off.max(self.off);
        }
        let force = DVec3::new((8.0 * now).cos(), (8.0 * now).sin(), 0.0);
        let enable = matches!(self.reading, Reading::At(_));
        self.device.write(force, enable, &frame);
        let mut board = self.cable.board();
        board.counts = [swing, -swing];
        to_board(&mut board.to_board);
        board.work();
        to_host(&mut board.to_host);
        let (told, asked) = (board.torques, board.asked.clone());
        drop(board);
        self.judge(told, &asked);
    }

    fn place(&self, swing: i64) -> DVec3 {
        let angles = [1138 - swing, 81 + swing].map(|count| TAU * count as f64 / 2440.0);
        MODEL.to_device(MODEL.pantograph.pose(angles).unwrap().position)
    }

    /// A torque of nothing is never wrong, only missing.
    fn judge(&mut self, told: [f32; 2], asked: &[[f32; 2]]) {
        let recent = &asked[asked.len().saturating_sub(LATE_REQUESTS)..];
        let right = (0..2).all(|port| {
            told[port] == 0.0
                || recent
                    .iter()
                    .any(|asked| (told[port] - asked[port]).abs() < 2e-4)
        });
        self.wrong = if right { 0 } else { self.wrong + 1 };
        self.longest_wrong = self.longest_wrong.max(self.wrong);
    }
}

#[test]
fn after_a_single_hit_no_wrong_force_stays_and_all_recovers() {
    let mut dice = Dice(0x5EED);
    let mut run = Run::new();
    let mut hits = [0; 6];
    let mut longest_without = 0;
    for _ in 0..3000 {
        let way = dice.below(2) as usize;
        let mut kind = 0;
        if way == 0 {
            run.step(&mut |bytes| kind = dice.hurt(bytes), &mut |_| ());
        } else {
            run.step(&mut |_| (), &mut |bytes| kind = dice.hurt(bytes));
        }
        hits[3 * way + kind] += 1;
        let mut without = 0;
        for _ in 0..60 {
            run.clean_ticks(1);
            without += u32::from(!matches!(run.reading, Reading::At(_)));
        }
        longest_without = longest_without.max(without);
        assert!(matches!(run.reading, Reading::At(_)), "{:?}", run.reading);
    }
    // Counts lost in dozens of setups, and what the arms did meanwhile.
    assert!(run.farthest_off < 0.01, "{}", run.farthest_off);
    assert!(hits.iter().all(|count| *count > 300), "{hits:?}");
    assert!(run.longest_wrong <= WRONG_TICKS, "{}", run.longest_wrong);
    assert!(longest_without <= 10, "{longest_without}");
    let board = run.cable.board();
    // Some hits did reset or set up the board, and it was brought back.
    assert!(
        board.resets > 10 && board.setups > 20,
        "{} {}",
        board.resets,
        board.setups
    );
}

#[test]
fn after_a_storm_the_device_works_or_says_that_it_lost_its_place() {
    for seed in 1..40 {
        let mut dice = Dice(seed * 7919);
        let mut run = Run::new();
        for _ in 0..300 {
            let mut other = Dice(dice.below(u64::MAX - 1) + 1);
            run.step(
                &mut |bytes| _ = (dice.below(4) == 0).then(|| dice.hurt(bytes)),
                &mut |bytes| _ = (other.below(4) == 0).then(|| other.hurt(bytes)),
            );
        }
        run.clean_ticks(200);
        let limp = run.cable.board().torques == [0.0; 2];
        match run.reading {
            Reading::At(_) => assert_eq!(run.wrong, 0),
            Reading::Waiting(reason::LOST_PLACE) => assert!(limp),
            other => panic!("seed {seed}: {other:?}, limp: {limp}"),
        }
    }
}

/// Nothing but noise, as from another machine on the port.
#[test]
fn noise_alone_is_never_taken_for_a_device() {
    let cable = Cable::default();
    let calibration = Calibration {
        degrees: MODEL.rest_degrees(),
        always: false,
    };
    let mut device = HaplyDevice::open(cable.clone(), MODEL, calibration).unwrap();
    let mut dice = Dice(1);
    for tick in 0..20_000 {
        cable
            .board()
            .to_host
            .extend((0..40).map(|_| dice.below(256) as u8));
        let now = f64::from(tick) * TICK;
        let reading = device.read(now, TICK, &DeviceFrame::default());
        assert!(!matches!(reading, Reading::At(_)), "{tick}");
        device.write(DVec3::X, false, &DeviceFrame::default());
    }
    assert!(
        cable
            .board()
            .asked
            .iter()
            .flatten()
            .all(|torque| *torque < 1e-20)
    );
}
