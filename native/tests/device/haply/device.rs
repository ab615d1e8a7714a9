//! The 2DIY against a board in memory.

use crate::haply::board::{Board, Cable};
use crate::haply::protocol::answer;
use glam::{DMat3, DVec2, DVec3};
use palpate_servo::device::haply::device::{Calibration, HaplyDevice};
use palpate_servo::device::haply::model::{MODELS, TORQUE_LIMIT};
use palpate_servo::device::reason;
use palpate_servo::device::{Device, DeviceFrame, Fault, Probe, Reading};
use std::f64::consts::TAU;

const TICK: f64 = 1e-3;

struct Bench {
    cable: Cable,
    device: Option<HaplyDevice<Cable>>,
    now: f64,
    force: DVec3,
    enable: bool,
}

impl Bench {
    fn new() -> Self {
        let mut bench = Self {
            cable: Cable::default(),
            device: None,
            now: 0.0,
            force: DVec3::ZERO,
            enable: true,
        };
        bench.start(false);
        bench
    }

    fn start(&mut self, always: bool) {
        self.start_at(MODELS[0].rest_degrees(), always);
    }

    fn start_at(&mut self, degrees: [f32; 2], always: bool) {
        let calibration = Calibration { degrees, always };
        let device = HaplyDevice::open(self.cable.clone(), &MODELS[0], calibration).unwrap();
        self.device = Some(device);
    }

    fn device(&mut self) -> &mut HaplyDevice<Cable> {
        self.device.as_mut().unwrap()
    }

    fn tick(&mut self) -> Reading {
        let (now, force, enable) = (self.now, self.force, self.enable);
        let device = self.device();
        let reading = device.read(now, TICK, &DeviceFrame::default());
        let enable = enable && matches!(reading, Reading::At(_));
        device.write(force, enable, &DeviceFrame::default());
        self.now += TICK;
        self.board().work();
        reading
    }

    fn ticks(&mut self, count: usize) -> Reading {
        (1..count).for_each(|_| _ = self.tick());
        self.tick()
    }

    fn board(&self) -> std::sync::MutexGuard<'_, Board> {
        self.cable.board()
    }

    /// Turns both arms by whole counts, in a tick for each 20 of them.
    fn turn(&mut self, first: i64, second: i64) {
        let parts = (first.abs().max(second.abs()) + 19) / 20;
        for part in 0..parts {
            let share = |all: i64| all * (part + 1) / parts - all * part / parts;
            self.board().counts[1] += share(first);
            self.board().counts[0] += share(second);
            self.tick();
        }
    }
}

fn at(reading: Reading) -> Probe {
    match reading {
        Reading::At(probe) => probe,
        other => panic!("{other:?}"),
    }
}

/// Where the handle is with the arms so many counts from the rest pose.
fn expected(first: i64, second: i64) -> DVec3 {
    let angle = |rest: i64, turned: i64| TAU * (rest + turned) as f64 / 2440.0;
    let pose = MODELS[0]
        .pantograph
        .pose([angle(1138, first), angle(81, second)]);
    MODELS[0].to_device(pose.unwrap().position)
}

#[test]
fn a_board_that_knows_nothing_is_set_up_once_and_then_told_where_the_handle_is() {
    let mut bench = Bench::new();
    assert_eq!(bench.tick(), Reading::Waiting(reason::NO_BOARD));
    let probe = at(bench.ticks(20));
    assert_eq!(bench.board().setups, 1);
    assert_eq!(bench.board().resets, 0);
    assert!(probe.position.distance(expected(0, 0)) < 1e-7);
    assert!(
        (probe.position - DVec3::new(0.0, 0.059, 0.0))
            .abs()
            .max_element()
            < 5e-4
    );
    bench.turn(-200, 200);
    let probe = at(bench.ticks(2));
    assert!(probe.position.distance(expected(-200, 200)) < 1e-7);
    assert_eq!(bench.board().setups, 1);
    let report = bench.device().report();
    assert_eq!(report.greeting.unwrap().axes, 2);
    assert_eq!(report.hellos, 1);
}

#[test]
fn a_known_board_keeps_its_angles_unless_the_user_wants_new_ones() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.turn(-200, 200);
    bench.device().park();
    bench.start(false);
    let probe = at(bench.ticks(20));
    assert!(probe.position.distance(expected(-200, 200)) < 1e-7);
    assert_eq!(bench.board().setups, 1);
    bench.device().park();
    bench.start(true);
    let probe = at(bench.ticks(20));
    assert!(probe.position.distance(expected(0, 0)) < 1e-7);
    assert_eq!(bench.board().setups, 2);
}

#[test]
fn the_handle_may_rest_where_the_user_says() {
    let mut bench = Bench::new();
    bench.start_at([150.0, 30.0], true);
    let probe = at(bench.ticks(20));
    // 150 degrees are 1016.7 counts, 30 are 203.3; whole ones are kept.
    assert!(probe.position.distance(expected(1016 - 1138, 203 - 81)) < 1e-7);
}

#[test]
fn a_force_becomes_torques_and_what_is_normal_to_the_plane_is_dropped() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.turn(-200, 200);
    bench.force = DVec3::new(0.3, -0.5, 0.8);
    bench.ticks(3);
    let angle = |count: f64| TAU * count / 2440.0;
    let pose = MODELS[0]
        .pantograph
        .pose([angle(938.0), angle(281.0)])
        .unwrap();
    let [first, second] = pose.torques(DVec2::new(-0.3, 0.5));
    let told = bench.board().torques;
    for (told, meant) in told.into_iter().zip([second, first]) {
        // Within the rounding of torques and a step of the PWM.
        let allowed = 0.016 * meant.abs() + 0.156 / 1023.0;
        assert!((f64::from(told) - meant).abs() < allowed, "{told} {meant}");
    }
    // In a frame that is turned the plane turns along.
    let turned = DeviceFrame {
        rotation: DMat3::from_rotation_x(TAU / 4.0),
        ..DeviceFrame::default()
    };
    let device = bench.device();
    let seen = at(device.read(1.0, TICK, &turned)).position;
    assert!(seen.y.abs() < 1e-9 && seen.z < -0.005, "{seen}");
    device.write(DVec3::Y, true, &turned);
    bench.board().work();
    assert_eq!(bench.board().torques, [0.0; 2]);
}

#[test]
fn torques_beyond_the_motors_are_shortened_together() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.turn(-200, 200);
    bench.force = DVec3::new(20.0, 30.0, 0.0);
    bench.ticks(3);
    let [second, first] = bench.board().torques.map(f64::from);
    assert!(first.abs().max(second.abs()) <= 1.016 * TORQUE_LIMIT);
    let pose = MODELS[0]
        .pantograph
        .pose([938.0, 281.0].map(|c| TAU * c / 2440.0))
        .unwrap();
    let [a, b] = pose.torques(DVec2::new(-20.0, -30.0));
    assert!((first / second - a / b).abs() < 0.05 * (a / b).abs());
}

#[test]
fn a_disabled_a_dropped_and_a_parked_device_are_limp() {
    for ending in 0..3 {
        let mut bench = Bench::new();
        bench.ticks(20);
        bench.force = DVec3::new(0.0, -1.0, 0.0);
        bench.ticks(3);
        assert!(bench.board().torques[0].abs() > 0.01);
        match ending {
            0 => {
                bench.enable = false;
                bench.tick();
            }
            1 => bench.device = None,
            _ => bench.device().park(),
        }
        bench.board().work();
        assert_eq!(bench.board().torques, [0.0; 2], "{ending}");
    }
}

fn pushing() -> Bench {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.force = DVec3::new(0.0, -1.0, 0.0);
    bench.ticks(3);
    bench
}

#[test]
fn who_parks_waits_for_a_line_that_takes_nothing_and_leaves_the_rest_to_the_guardian() {
    let mut bench = pushing();
    bench.board().refusals = 20;
    bench.device().park();
    bench.board().work();
    assert_eq!(bench.board().torques, [0.0; 2]);
    assert!(bench.board().dismissed);

    let mut bench = pushing();
    bench.board().full = true;
    bench.device().park();
    assert!(!bench.board().dismissed, "it alone can still say zero");
}

#[test]
fn a_line_that_breaks_is_left_to_the_guardian() {
    let mut bench = pushing();
    bench.board().gone = true;
    bench.tick();
    assert!(!bench.board().dismissed);
}

#[test]
fn silence_is_stale_after_20_ms_and_asks_on_without_torque() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.force = DVec3::new(0.0, -1.0, 0.0);
    bench.ticks(3);
    bench.board().silent = true;
    bench.ticks(19);
    assert_eq!(bench.ticks(3), Reading::Fault(Fault::Stale));
    assert_eq!(bench.board().torques, [0.0; 2]);
    bench.board().silent = false;
    bench.turn(-50, 50);
    let probe = at(bench.ticks(8));
    assert!(!probe.restart);
    assert!(probe.position.distance(expected(-50, 50)) < 1e-7);
    assert_eq!(bench.board().setups, 1);
}

#[test]
fn a_board_that_was_reset_on_the_way_goes_on_from_the_last_angles() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.turn(-200, 200);
    bench.force = DVec3::new(0.0, -1.0, 0.0);
    bench.ticks(150);
    assert!(bench.board().torques[0].abs() > 0.01);
    bench.board().to_board.extend([0, 0]);
    bench.ticks(4);
    // Its motors cannot be reached before it is set up again.
    bench.enable = false;
    bench.ticks(4);
    assert_eq!(bench.board().torques, [0.0; 2]);
    let probe = at(bench.ticks(10));
    assert_eq!(bench.board().setups, 2);
    // Converting an angle to counts may lose one.
    assert!(probe.position.distance(expected(-200, 200)) < 5e-4);
}

#[test]
fn a_plug_pulled_means_a_new_start_for_the_angles() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.force = DVec3::new(0.0, -1.0, 0.0);
    bench.ticks(3);
    *bench.board() = Board {
        gone: true,
        ..Board::default()
    };
    assert_eq!(bench.ticks(2), Reading::Fault(Fault::Unplugged));
    bench.board().gone = false;
    assert_eq!(bench.ticks(400), Reading::Waiting(reason::LOST_PLACE));
    assert_eq!(bench.board().torques, [0.0; 2]);
    assert_eq!(bench.board().address, MODELS[0].adrift_address());
    assert_eq!(bench.device().report().reopened, 1);
    // Started again by somebody who has read that.
    bench.device().park();
    bench.start(false);
    assert!(at(bench.ticks(80)).position.distance(expected(0, 0)) < 1e-7);
}

#[test]
fn a_full_line_holds_nothing_up_and_letting_go_comes_first() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.force = DVec3::new(0.0, -1.0, 0.0);
    bench.ticks(3);
    bench.board().silent = true;
    bench.board().full = true;
    bench.ticks(3);
    assert!(bench.device().report().unsent >= 3);
    bench.board().full = false;
    bench.enable = false;
    bench.tick();
    assert_eq!(bench.board().torques, [0.0; 2]);
}

#[test]
fn stretched_arms_get_no_force() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.force = DVec3::new(0.0, -0.5, 0.0);
    // Elbows together, in small steps: no hand turns arms any faster.
    for _ in 0..60 {
        bench.turn(-8, 8);
        bench.tick();
    }
    assert!(matches!(bench.tick(), Reading::At(_)));
    for _ in 0..500 {
        bench.turn(-1, 1);
        if matches!(bench.tick(), Reading::Passive(_, reason::STRETCHED)) {
            assert!(matches!(bench.tick(), Reading::Passive(..)));
            assert_eq!(bench.board().torques, [0.0; 2]);
            return;
        }
    }
    panic!("never stretched");
}

#[test]
fn answers_from_elsewhere_are_not_followed() {
    let mut bench = Bench::new();
    bench.ticks(20);
    let rest = at(bench.tick()).position;
    // On the grid, with the right address, but half a turn away.
    let lie = answer([1300, 40], 2440.0);
    bench.board().to_host.extend(lie);
    let probe = at(bench.tick());
    assert_eq!(probe.position, rest);
    assert!(bench.device().report().crc_errors > 0);
    assert_eq!(at(bench.ticks(3)).position, rest);
}

#[test]
fn letting_go_does_not_wait_for_answers() {
    let mut bench = Bench::new();
    bench.ticks(20);
    bench.force = DVec3::new(0.0, -1.0, 0.0);
    bench.ticks(3);
    bench.board().silent = true;
    // As many requests as may be on the way.
    bench.ticks(4);
    assert!(bench.board().torques[0].abs() > 0.01);
    bench.enable = false;
    bench.tick();
    assert_eq!(bench.device().report().unsent, 0);
    assert_eq!(bench.board().torques, [0.0; 2]);
}

#[test]
fn what_was_said_before_the_first_question_is_not_an_answer_to_it() {
    let mut bench = Bench::new();
    bench.board().to_host.extend(answer([1138, 1138], 2440.0));
    let probe = at(bench.ticks(80));
    assert_eq!(bench.board().setups, 1);
    assert!(probe.position.distance(expected(0, 0)) < 1e-7);
}

#[test]
fn a_board_that_was_set_up_with_other_angles_than_were_sent_is_not_believed() {
    let mut bench = Bench::new();
    while bench.board().setups == 0 {
        bench.tick();
    }
    // As if bits of the message had flipped: far from the rest pose, but whole counts.
    bench.board().zero[0] += 300;
    bench.board().to_host.clear();
    assert_eq!(bench.ticks(100), Reading::Waiting(reason::LOST_PLACE));
    assert_eq!(bench.board().address, MODELS[0].adrift_address());
}
