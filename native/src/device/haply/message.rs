//! Messages of the hAPI protocol, byte for byte.
//!
//! A board reads a command byte, an address and as many bytes as it believes to follow; nothing marks
//! a beginning. Bytes other than 0, 1 and 2 where a command should be are skipped. So torques are
//! written such that none of their bytes is one of these three (`torque_bytes`): a board that has
//! lost its place skips to the next message by itself, and neither resets nor sets itself up anew on
//! the way. Answers are recognised by their angles, which must be whole encoder counts.

use crate::device::haply::model::Model;

/// Command: forget the device and its ports. The motors keep what they had.
pub const RESET: u8 = 0;
/// Command: set up the ports of motors and encoders.
pub const SETUP: u8 = 1;
/// Command: take torques, answer with angles.
pub const TORQUES: u8 = 2;
/// No command, no address of ours, and harmless as any byte of a torque.
pub const FILL: u8 = 0x10;
/// Length of a message that sets up two motors and two encoders.
pub const SETUP_BYTES: usize = 26;
/// Length of a message with two torques.
pub const TORQUE_BYTES: usize = 10;
/// Length of the answer with two angles.
pub const ANSWER_BYTES: usize = 9;

/// Torques smaller than this are none, N m.
const LEAST_TORQUE: f64 = 1e-6;
/// Distance of an angle from a whole count in units of its last place: boards may round twice.
const GRID_ULPS: u32 = 2;

/// Sets up both arms, whose encoders stand at `degrees` (arm 1, arm 2) now.
///
/// Layout: command, address, motor ports (a bit each), their senses, encoder ports, their senses,
/// number of sensors, number of PWM pins, then offset and resolution of each encoder; always in the
/// order of ports.
pub fn setup_message(model: &Model, address: u8, degrees: [f32; 2]) -> [u8; SETUP_BYTES] {
    let mut message = [0; SETUP_BYTES];
    message[..3].copy_from_slice(&[SETUP, address, 0b11]);
    message[5] = 0b11;
    for (arm, degrees) in model.arms.iter().zip(degrees) {
        message[3 + arm.port] = arm.motor_sense;
        message[6 + arm.port] = arm.encoder_sense;
        let at = 10 + 8 * arm.port;
        message[at..at + 4].copy_from_slice(&degrees.to_le_bytes());
        message[at + 4..at + 8].copy_from_slice(&arm.resolution.to_le_bytes());
    }
    message
}

/// Asks for `torques` (N m, arm 1, arm 2) and for an answer.
pub fn torque_message(model: &Model, address: u8, torques: [f64; 2]) -> [u8; TORQUE_BYTES] {
    let mut message = [FILL; TORQUE_BYTES];
    message[..2].copy_from_slice(&[TORQUES, address]);
    for (arm, torque) in model.arms.iter().zip(torques) {
        let at = 2 + 4 * arm.port;
        message[at..at + 4].copy_from_slice(&torque_bytes(torque));
    }
    message
}

/// A torque (N m) as a float of which no byte is a command, within 1.6 %.
///
/// The two low bytes are [`FILL`], so that a board which has lost a byte or two reads next to
/// nothing instead of a wrong torque; in the third, 0, 1 and 2 give way to the nearest other value.
/// No torque, and anything not finite, is four times [`FILL`]: 3e-29.
pub fn torque_bytes(torque: f64) -> [u8; 4] {
    let size = torque.abs();
    if !torque.is_finite() || size < LEAST_TORQUE || size > f64::from(f32::MAX) {
        return [FILL; 4];
    }
    let low = u32::from_le_bytes([FILL, FILL, 0, 0]);
    let mut high = ((size as f32).to_bits() + 0x8000 - low) >> 16;
    match high & 0xFF {
        0 => high -= 1,
        1 => high -= 2,
        2 => high += 1,
        _ => {}
    }
    let sign = u32::from(torque < 0.0) << 31;
    (sign | high << 16 | low).to_le_bytes()
}

/// Angles (arm 1, arm 2, degrees) of an answer from `address`; None unless every byte fits.
pub fn parse_answer(model: &Model, address: u8, answer: &[u8; ANSWER_BYTES]) -> Option<[f64; 2]> {
    if answer[0] != address {
        return None;
    }
    let mut degrees = [0.0; 2];
    for (arm, degrees) in model.arms.iter().zip(&mut degrees) {
        let at = 1 + 4 * arm.port;
        let bytes = [answer[at], answer[at + 1], answer[at + 2], answer[at + 3]];
        let angle = f32::from_le_bytes(bytes);
        if !is_whole_count(angle, arm.resolution) {
            return None;
        }
        *degrees = f64::from(angle);
    }
    Some(degrees)
}

/// Whether a board that computes 360 * count / resolution can have said this angle (degrees), within
/// two turns. Boards that count half as finely say even counts only.
fn is_whole_count(angle: f32, resolution: f32) -> bool {
    if angle.is_nan() || angle.abs() > 720.0 {
        return false;
    }
    let resolution = f64::from(resolution);
    let count = (f64::from(angle) * resolution / 360.0).round();
    let exact = (360.0 * count / resolution) as f32;
    // Neighbouring floats of one sign are neighbouring numbers as bits.
    angle == exact || (count != 0.0 && angle.to_bits().abs_diff(exact.to_bits()) <= GRID_ULPS)
}
