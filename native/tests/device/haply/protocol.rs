//! The 2DIY: geometry of its arms, bytes of its protocol.

use std::f64::consts::TAU;

use glam::DVec2;
use palpate_servo::device::haply::message::{
    ANSWER_BYTES, FILL, parse_answer, setup_message, torque_bytes, torque_message,
};
use palpate_servo::device::haply::model::{MODELS, Model, TORQUE_LIMIT};
use palpate_servo::device::haply::pantograph::{Pantograph, Pose};

// ------------------------------------------------------------------------------------ geometry

fn places(model: &Model) -> impl Iterator<Item = DVec2> {
    let (centre, half) = (model.centre, model.half_extents);
    (-8..=8).flat_map(move |i| {
        (-8..=8).map(move |j| centre + half * DVec2::new(f64::from(i), f64::from(j)) / 8.0)
    })
}

fn pose_at(pantograph: &Pantograph, place: DVec2) -> ([f64; 2], Pose) {
    let angles = pantograph.angles(place).unwrap();
    (angles, pantograph.pose(angles).unwrap())
}

#[test]
fn the_handle_is_where_both_forearms_end() {
    for model in &MODELS {
        let arm = &model.pantograph;
        for place in places(model) {
            let (angles, pose) = pose_at(arm, place);
            assert!(
                pose.position.distance(place) < 1e-12,
                "{} {place}",
                model.key
            );
            let motors = [DVec2::ZERO, DVec2::new(arm.spacing, 0.0)];
            for (motor, angle) in motors.into_iter().zip(angles) {
                let elbow = motor + DVec2::from_angle(angle) * arm.proximal;
                assert!((elbow.distance(place) - arm.distal).abs() < 1e-12);
            }
            assert!(pose.sine > 0.5, "{} {place}: {}", model.key, pose.sine);
        }
    }
}

#[test]
fn the_jacobian_agrees_with_finite_differences_and_virtual_work() {
    for model in &MODELS {
        let arm = &model.pantograph;
        for place in places(model) {
            let (angles, pose) = pose_at(arm, place);
            for motor in 0..2 {
                let [ahead, behind] = [1e-6, -1e-6].map(|turn| {
                    let mut angles = angles;
                    angles[motor] += turn;
                    arm.pose(angles).unwrap().position
                });
                let slope = (ahead - behind) / 2e-6;
                assert!(slope.distance(pose.columns[motor]) < 1e-8);
            }
            // tau . dtheta = F . dx for small turns of both motors at once.
            let (force, turn) = (DVec2::new(0.7, -0.4), [3e-7, -2e-7]);
            let moved = arm
                .pose([angles[0] + turn[0], angles[1] + turn[1]])
                .unwrap();
            let by_force = force.dot(moved.position - pose.position);
            let [first, second] = pose.torques(force);
            let by_motors = first * turn[0] + second * turn[1];
            assert!((by_force - by_motors).abs() < 1e-5 * by_motors.abs().max(1e-9));
        }
    }
}

#[test]
fn the_largest_force_can_be_had_in_every_direction_and_no_larger_one() {
    for model in &MODELS {
        for place in places(model) {
            let (_, pose) = pose_at(&model.pantograph, place);
            let force = pose.largest_force(TORQUE_LIMIT);
            let needed = (0..3600)
                .map(|i| DVec2::from_angle(TAU * f64::from(i) / 3600.0) * force)
                .flat_map(|force| pose.torques(force))
                .fold(0.0, |most: f64, torque| most.max(torque.abs()));
            assert!(needed <= TORQUE_LIMIT * (1.0 + 1e-12), "{needed}");
            assert!(needed > TORQUE_LIMIT * (1.0 - 1e-6), "{needed}");
        }
    }
}

#[test]
fn poses_that_cannot_be_are_none_and_singular_ones_give_no_force() {
    let arm = MODELS[0].pantograph;
    let long = Pantograph {
        spacing: 0.5,
        ..arm
    };
    assert_eq!(long.pose([3.0, 0.0]), None);
    assert_eq!(arm.angles(DVec2::new(0.0, 0.2)), None);
    // Both elbows in one place: the handle may swing round them.
    assert_eq!(MODELS[2].pantograph.pose([1.5, 1.5]), None);
    assert_eq!(arm.pose([f64::NAN, 0.0]), None);
    // Forearms almost on one line.
    let wide = Pantograph {
        spacing: 0.3,
        ..arm
    };
    let mut last = f64::INFINITY;
    for gap in [1e-2_f64, 1e-4, 1e-6, 1e-8] {
        let angle = ((0.15 - 0.09 + gap * 0.09) / 0.07_f64).acos();
        let pose = wide.pose([angle, TAU / 2.0 - angle]).unwrap();
        let force = pose.largest_force(TORQUE_LIMIT);
        assert!(force < 0.2 * last, "{gap}: {force}");
        last = force;
    }
}

// --------------------------------------------------------------------------------------- bytes

#[test]
fn a_setup_is_byte_exact() {
    let message = setup_message(&MODELS[0], 0x20, [168.0, 12.0]);
    let expected = [
        0x01, 0x20, 0x03, 0x01, 0x01, 0x03, 0x01, 0x01, 0x00, 0x00, // what is where
        0x00, 0x00, 0x40, 0x41, 0x00, 0x80, 0x98, 0x45, // port 1: 12 degrees, 4880
        0x00, 0x00, 0x28, 0x43, 0x00, 0x80, 0x98, 0x45, // port 2: 168 degrees, 4880
    ];
    assert_eq!(message, expected);
    // Senses differ in the older one, and its first arm hangs on the second port.
    let message = setup_message(&MODELS[2], 0x22, [241.0, -61.0]);
    assert_eq!(message[..10], [1, 0x22, 3, 0, 1, 3, 0, 1, 0, 0]);
    assert_eq!(message[10..14], (-61.0_f32).to_le_bytes());
    assert_eq!(message[18..22], 241.0_f32.to_le_bytes());
}

#[test]
fn torques_are_byte_exact_and_in_the_order_of_ports() {
    let message = torque_message(&MODELS[0], 0x20, [0.05, -0.02]);
    let expected = [0x02, 0x20, 0x10, 0x10, 0xA4, 0xBC, 0x10, 0x10, 0x4D, 0x3D];
    assert_eq!(message, expected);
    let limp = torque_message(&MODELS[0], 0x20, [0.0; 2]);
    assert_eq!(limp, [0x02, 0x20, 16, 16, 16, 16, 16, 16, 16, 16]);
}

#[test]
fn no_byte_of_a_torque_is_a_command_and_none_is_far_off() {
    let mut worst = 0.0_f64;
    for step in 0..200_000 {
        let torque =
            1e-6 * 1.0001_f64.powi(step % 120_000) * if step % 2 == 0 { 1.0 } else { -1.0 };
        let bytes = torque_bytes(torque);
        assert!(bytes.iter().all(|byte| *byte > 2), "{torque}: {bytes:?}");
        let sent = f64::from(f32::from_le_bytes(bytes));
        worst = worst.max((sent / torque - 1.0).abs());
    }
    assert!(worst < 0.016, "{worst}");
    assert!(worst > 0.004, "nothing gave way: {worst}");
    for none in [0.0, -0.0, 1e-9, f64::NAN, f64::INFINITY] {
        assert_eq!(torque_bytes(none), [FILL; 4]);
    }
}

#[test]
fn a_board_that_missed_a_byte_or_two_reads_next_to_nothing() {
    for step in 1..2000 {
        let torque = TORQUE_LIMIT * f64::from(step) / 2000.0;
        let message = torque_message(&MODELS[0], 0x20, [torque, -torque]);
        let two: Vec<u8> = [message, message].concat();
        for missed in [1, 2] {
            let floats = two[2 + missed..].chunks_exact(4).take(2);
            for float in floats {
                let read = f32::from_le_bytes(float.try_into().unwrap());
                assert!(read.abs() < 1e-18, "{torque} {missed}: {read}");
            }
        }
    }
}

pub fn answer(counts: [i32; 2], resolution: f64) -> [u8; ANSWER_BYTES] {
    let mut answer = [0x20; ANSWER_BYTES];
    for (port, count) in counts.into_iter().enumerate() {
        let angle = (360.0 * f64::from(count) / resolution) as f32;
        answer[1 + 4 * port..5 + 4 * port].copy_from_slice(&angle.to_le_bytes());
    }
    answer
}

#[test]
fn answers_are_whole_counts_of_either_board() {
    let model = &MODELS[0];
    let exact = answer([81, 1138], 2440.0);
    let [first, second] = parse_answer(model, 0x20, &exact).unwrap();
    assert!((first - 360.0 * 1138.0 / 2440.0).abs() < 1e-4);
    assert!((second - 360.0 * 81.0 / 2440.0).abs() < 1e-5);
    assert!(parse_answer(model, 0x20, &answer([-163, 2277], 4880.0)).is_some());
    assert!(parse_answer(model, 0x20, &answer([0, 0], 4880.0)).is_some());
    assert_eq!(parse_answer(model, 0x21, &exact), None);
    assert_eq!(parse_answer(model, 0x20, &answer([9800, 0], 4880.0)), None);
}

/// The mantissa's last bits are the only ones that may differ.
#[test]
fn damaged_answers_are_told_from_sound_ones() {
    let model = &MODELS[0];
    let (mut taken, mut tried) = (0, 0);
    for count in (-500..2000).step_by(7) {
        let sound = answer([count, 1138], 2440.0);
        for bit in 8..8 * ANSWER_BYTES {
            let mut damaged = sound;
            damaged[bit / 8] ^= 1 << (bit % 8);
            tried += 1;
            taken += u32::from(
                parse_answer(model, 0x20, &damaged).is_some_and(|[_, second]| {
                    let truth = 360.0 * f64::from(count) / 2440.0;
                    (second - truth).abs() > 1e-3
                }),
            );
        }
        for shift in 1..ANSWER_BYTES {
            let mut shifted = sound;
            shifted.rotate_left(shift);
            shifted[0] = 0x20;
            tried += 1;
            taken += u32::from(parse_answer(model, 0x20, &shifted).is_some());
        }
    }
    // A flipped sign or exponent may give a whole count again; the jump gives these away.
    assert!(taken * 100 < tried * 6, "{taken} of {tried}");
}

// -------------------------------------------------------------------------------------- device
