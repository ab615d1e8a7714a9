//! Messages of the link, protocols 1 and 2: what a payload says.

use glam::{DQuat, DVec3};

use crate::device::report::Greeting;

/// Protocol in which neither end tells of freshness.
pub const FIRST_PROTOCOL: u8 = 1;
/// Protocol that is spoken with whoever knows it.
pub const PROTOCOL: u8 = 2;

const HELLO: u8 = 0x01;
const STATE: u8 = 0x02;
const FORCE: u8 = 0x03;
const FAULT: u8 = 0x04;
const ORIENTATION: u8 = 0x05;

/// Steps of a quaternion's component of 1 in an ORIENTATION.
const QUATERNION_UNIT: f64 = 32_767.0;
/// Step of a damping, N s/m, and of an age, s.
const DAMPING_STEP: f64 = 0.01;
const AGE_STEP: f64 = 1e-5;
/// Shortest and longest quaternion that is believed, in its own steps: within 1 % of a unit's.
const QUATERNION_LENGTHS: [i64; 2] = [32_440, 33_094];

/// State of a device: position, buttons, readiness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeviceState {
    /// Counts up by one a message, wraps.
    pub sequence: u16,
    /// The device's clock, us, wraps.
    pub time_us: u32,
    /// Position, um.
    pub position_um: [i32; 3],
    /// A bit a button.
    pub buttons: u8,
    /// The device can give force.
    pub ready: bool,
    /// The device has a fault of its own.
    pub fault: bool,
    /// What it tells of FORCE, in protocol 2.
    pub taken: Option<Taken>,
}

/// The last FORCE that a device took in this session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Taken {
    /// None yet.
    Nothing,
    /// The one of this sequence.
    Force(u16),
}

/// What a FORCE of protocol 2 says of itself.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Answer {
    /// Device time of the STATE that it answers, us.
    pub time_us: u32,
    /// Time since that came, s.
    pub age: f64,
    /// Damping that is asked for, N s/m.
    pub damping: f64,
}

impl DeviceState {
    /// Position, m, in the device's frame.
    pub fn position(&self) -> DVec3 {
        let [x, y, z] = self.position_um.map(f64::from);
        DVec3::new(x, y, z) * 1e-6
    }
}

/// Orientation of a device's stylus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DeviceOrientation {
    /// That of the STATE which it belongs to.
    pub sequence: u16,
    /// w, x, y, z in steps of 1/32767.
    pub quaternion: [i16; 4],
}

impl DeviceOrientation {
    /// Rotation from the stylus' axes to the device's; None unless it is a unit quaternion to 1 %.
    pub fn rotation(&self) -> Option<DQuat> {
        let square: i64 = self.quaternion.iter().map(|&c| i64::from(c).pow(2)).sum();
        let [shortest, longest] = QUATERNION_LENGTHS.map(|length| length.pow(2));
        (shortest..=longest).contains(&square).then(|| {
            let [w, x, y, z] = self.quaternion.map(|c| f64::from(c) / QUATERNION_UNIT);
            DQuat::from_xyzw(x, y, z, w).normalize()
        })
    }
}

/// A message of a device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Message {
    /// Answer to the host's HELLO.
    Hello(Greeting),
    /// One sample of the STATE stream.
    State(DeviceState),
    /// Orientation of the stylus in the STATE that follows.
    Orientation(DeviceOrientation),
    /// A fault report.
    Fault {
        /// The device's own number.
        code: u8,
        /// More about it.
        detail: u16,
    },
}

/// Reads a device's payload; None for an unknown type or a wrong length.
pub fn parse(payload: &[u8]) -> Option<Message> {
    let (&kind, rest) = payload.split_first()?;
    let mut fields = Fields(rest);
    let message = match kind {
        // Type and protocol stay where they are in every version; all else may change.
        HELLO if !matches!(*rest.first()?, FIRST_PROTOCOL | PROTOCOL) => {
            return Some(Message::Hello(Greeting {
                protocol: rest[0],
                ..Greeting::default()
            }));
        }
        HELLO => Message::Hello(Greeting {
            protocol: fields.take::<1>()?[0],
            name: fields.take()?,
            axes: fields.take::<1>()?[0],
            max_force: f32::from_le_bytes(fields.take()?),
            half_extents: [
                f32::from_le_bytes(fields.take()?),
                f32::from_le_bytes(fields.take()?),
                f32::from_le_bytes(fields.take()?),
            ],
            rate_hz: u16::from_le_bytes(fields.take()?),
            largest_damping: if rest[0] == FIRST_PROTOCOL {
                0.0
            } else {
                f32::from(u16::from_le_bytes(fields.take()?)) * DAMPING_STEP as f32
            },
        }),
        STATE => {
            let sequence = u16::from_le_bytes(fields.take()?);
            let time_us = u32::from_le_bytes(fields.take()?);
            let position_um = [
                i32::from_le_bytes(fields.take()?),
                i32::from_le_bytes(fields.take()?),
                i32::from_le_bytes(fields.take()?),
            ];
            let [buttons, flags] = fields.take()?;
            Message::State(DeviceState {
                sequence,
                time_us,
                position_um,
                buttons,
                ready: flags & 1 != 0,
                fault: flags & 2 != 0,
                taken: match fields.take() {
                    None => None,
                    Some(_) if flags & 4 == 0 => Some(Taken::Nothing),
                    Some(sequence) => Some(Taken::Force(u16::from_le_bytes(sequence))),
                },
            })
        }
        FAULT => Message::Fault {
            code: fields.take::<1>()?[0],
            detail: u16::from_le_bytes(fields.take()?),
        },
        ORIENTATION => Message::Orientation(DeviceOrientation {
            sequence: u16::from_le_bytes(fields.take()?),
            quaternion: [
                i16::from_le_bytes(fields.take()?),
                i16::from_le_bytes(fields.take()?),
                i16::from_le_bytes(fields.take()?),
                i16::from_le_bytes(fields.take()?),
            ],
        }),
        _ => return None,
    };
    fields.0.is_empty().then_some(message)
}

struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*head)
    }
}

/// The host's HELLO.
pub const fn hello_payload(protocol: u8) -> [u8; 2] {
    [HELLO, protocol]
}

/// The host's FORCE in protocol 1: millinewtons, rounded, cut to what fits.
pub fn force_payload(sequence: u16, force: DVec3, enable: bool) -> [u8; 10] {
    let mut payload = [0; 10];
    payload[0] = FORCE;
    payload[1..3].copy_from_slice(&sequence.to_le_bytes());
    for (axis, newtons) in force.to_array().into_iter().enumerate() {
        // A cast from float to integer saturates, and takes NaN to zero.
        let millinewtons = (newtons * 1e3).round() as i16;
        payload[3 + 2 * axis..5 + 2 * axis].copy_from_slice(&millinewtons.to_le_bytes());
    }
    payload[9] = u8::from(enable);
    payload
}

/// The same in protocol 2: a FORCE and what it says of itself.
pub fn answering_payload(force: [u8; 10], answer: &Answer) -> [u8; 18] {
    const DAMP: u8 = 2;
    // Casts from float to integer saturate.
    let damping = (answer.damping / DAMPING_STEP).round() as u16;
    let age = (answer.age / AGE_STEP).ceil() as u16;
    let mut payload = [0; 18];
    payload[..10].copy_from_slice(&force);
    if damping > 0 {
        payload[9] |= DAMP;
    }
    payload[10..14].copy_from_slice(&answer.time_us.to_le_bytes());
    payload[14..16].copy_from_slice(&age.to_le_bytes());
    payload[16..].copy_from_slice(&damping.to_le_bytes());
    payload
}
