//! Frames of the link, version 1: COBS(payload + CRC-16/CCITT-FALSE) and a zero byte.

use crc::{CRC_16_IBM_3740, Crc};
use glam::{DQuat, DVec3};

/// Longest frame on the wire, delimiter included.
pub const MAX_FRAME: usize = 62;
/// Longest payload: a byte of COBS overhead, two of CRC and the delimiter are added.
pub const MAX_PAYLOAD: usize = MAX_FRAME - 4;
/// Version of the link spoken here.
pub const PROTOCOL: u8 = 1;

/// The catalogue's name for CRC-16/CCITT-FALSE.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

const HELLO: u8 = 0x01;
const STATE: u8 = 0x02;
const FORCE: u8 = 0x03;
const FAULT: u8 = 0x04;
const ORIENTATION: u8 = 0x05;

/// What 1 is in an ORIENTATION.
const QUATERNION_UNIT: f64 = 32_767.0;
/// Shortest and longest quaternion that is believed, in its own steps: within 1 % of a unit's.
const QUATERNION_LENGTHS: [i64; 2] = [32_440, 33_094];

/// CRC-16/CCITT-FALSE of a payload.
pub fn checksum(payload: &[u8]) -> u16 {
    CRC.checksum(payload)
}

/// Writes the frame of `payload` and returns its length, or None if the payload is empty or longer
/// than [`MAX_PAYLOAD`].
pub fn encode(payload: &[u8], frame: &mut [u8; MAX_FRAME]) -> Option<usize> {
    if payload.is_empty() || payload.len() > MAX_PAYLOAD {
        return None;
    }
    let mut body = [0; MAX_PAYLOAD + 2];
    let length = payload.len();
    body[..length].copy_from_slice(payload);
    body[length..length + 2].copy_from_slice(&checksum(payload).to_le_bytes());
    let coded = cobs::try_encode(&body[..length + 2], &mut frame[..MAX_FRAME - 1]).ok()?;
    frame[coded] = 0;
    Some(coded + 1)
}

/// What was wrong with received bytes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DecodeErrors {
    /// Frames whose checksum did not fit.
    pub crc: u64,
    /// Frames that are not COBS, or too short to hold a payload.
    pub cobs: u64,
    /// Frames longer than [`MAX_FRAME`].
    pub oversize: u64,
}

/// Cuts a stream of bytes into payloads; allocates nothing and finds its way after any error at
/// the next delimiter.
#[derive(Debug, Clone)]
pub struct Decoder {
    buffer: [u8; MAX_FRAME],
    length: usize,
    overflowed: bool,
    /// Errors so far.
    pub errors: DecodeErrors,
}

impl Default for Decoder {
    fn default() -> Self {
        Self {
            buffer: [0; MAX_FRAME],
            length: 0,
            overflowed: false,
            errors: DecodeErrors::default(),
        }
    }
}

impl Decoder {
    /// Forgets a frame that was begun; the error counts stay.
    pub fn resynchronise(&mut self) {
        self.length = 0;
        self.overflowed = false;
    }

    /// Takes one byte; the payload when it ends a sound frame.
    pub fn push(&mut self, byte: u8) -> Option<&[u8]> {
        if byte != 0 {
            // The delimiter must fit too.
            if self.length < MAX_FRAME - 1 {
                self.buffer[self.length] = byte;
                self.length += 1;
            } else {
                self.overflowed = true;
            }
            return None;
        }
        let length = self.length;
        let overflowed = self.overflowed;
        self.resynchronise();
        if overflowed {
            self.errors.oversize += 1;
            return None;
        }
        if length == 0 {
            // Empty frames are allowed as padding between frames.
            return None;
        }
        let decoded = match cobs::decode_in_place(&mut self.buffer[..length]) {
            Ok(decoded) if decoded >= 3 => decoded,
            _ => {
                self.errors.cobs += 1;
                return None;
            }
        };
        let (payload, sum) = self.buffer[..decoded].split_at(decoded - 2);
        if sum != checksum(payload).to_le_bytes() {
            self.errors.crc += 1;
            return None;
        }
        Some(payload)
    }
}

/// What a device says of itself.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Greeting {
    /// Protocol version the device speaks; of another one than [`PROTOCOL`] nothing else is known.
    pub protocol: u8,
    /// UTF-8, zero padded.
    pub name: [u8; 16],
    /// Number of axes.
    pub axes: u8,
    /// Largest force, N.
    pub max_force: f32,
    /// Half extents of the workspace, m.
    pub half_extents: [f32; 3],
    /// Rate of the STATE stream, Hz.
    pub rate_hz: u16,
}

impl Greeting {
    /// Whether its figures can be those of a device.
    pub fn is_sound(&self) -> bool {
        let [x, y, z] = self.half_extents;
        [self.max_force, x, y, z]
            .iter()
            .all(|figure| figure.is_finite() && *figure >= 0.0)
    }
}

/// Where a device is.
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
}

impl DeviceState {
    /// Position, m, in the device's frame.
    pub fn position(&self) -> DVec3 {
        let [x, y, z] = self.position_um.map(f64::from);
        DVec3::new(x, y, z) * 1e-6
    }
}

/// How a device's stylus is turned.
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
    /// How the stylus is turned in the STATE that follows.
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
        HELLO if *rest.first()? != PROTOCOL => {
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
pub const fn hello_payload() -> [u8; 2] {
    [HELLO, PROTOCOL]
}

/// The host's FORCE: millinewtons, rounded, cut to what fits.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn decode_all(bytes: &[u8]) -> (Vec<Vec<u8>>, DecodeErrors) {
        let mut decoder = Decoder::default();
        let payloads = bytes
            .iter()
            .filter_map(|&b| decoder.push(b).map(<[u8]>::to_vec))
            .collect();
        (payloads, decoder.errors)
    }

    fn frame(payload: &[u8]) -> Vec<u8> {
        let mut frame = [0; MAX_FRAME];
        let length = encode(payload, &mut frame).unwrap();
        frame[..length].to_vec()
    }

    #[test]
    fn checksum_has_the_catalogues_check_value() {
        assert_eq!(checksum(b"123456789"), 0x29B1);
    }

    #[test]
    fn hello_and_force_are_these_bytes() {
        let sum = checksum(&[1, 1]).to_le_bytes();
        assert_eq!(frame(&hello_payload()), [5, 1, 1, sum[0], sum[1], 0]);
        let force = force_payload(0x0102, DVec3::new(1.0, -0.5, 0.0004), true);
        assert_eq!(force, [3, 2, 1, 0xE8, 3, 0x0C, 0xFE, 0, 0, 1]);
        assert_eq!(
            force_payload(0, DVec3::new(1e9, -1e9, f64::NAN), false)[3..9],
            {
                let mut b = [0; 6];
                b[..2].copy_from_slice(&i16::MAX.to_le_bytes());
                b[2..4].copy_from_slice(&i16::MIN.to_le_bytes());
                b
            }
        );
    }

    #[test]
    fn state_and_hello_are_read_field_by_field() {
        let mut state = vec![2, 0x34, 0x12, 1, 0, 0, 0x80];
        for um in [1_i32, -2, 70_000] {
            state.extend(um.to_le_bytes());
        }
        state.extend([5, 3]);
        let expected = DeviceState {
            sequence: 0x1234,
            time_us: 0x8000_0001,
            position_um: [1, -2, 70_000],
            buttons: 5,
            ready: true,
            fault: true,
        };
        assert_eq!(parse(&state), Some(Message::State(expected)));
        state.push(0);
        assert_eq!(parse(&state), None);

        let mut hello = vec![1, 1];
        hello.extend(*b"simulated\0\0\0\0\0\0\0");
        hello.push(3);
        for value in [3.5_f32, 0.1, 0.2, 0.3] {
            hello.extend(value.to_le_bytes());
        }
        hello.extend(1000_u16.to_le_bytes());
        assert_eq!(frame(&hello).len(), hello.len() + 4);
        let Some(Message::Hello(greeting)) = parse(&hello) else {
            panic!("HELLO not understood");
        };
        assert_eq!(greeting.max_force, 3.5);
        assert_eq!(greeting.half_extents, [0.1, 0.2, 0.3]);
        assert_eq!((greeting.axes, greeting.rate_hz), (3, 1000));
        let fault = Message::Fault {
            code: 7,
            detail: 256,
        };
        assert_eq!(parse(&[4, 7, 0, 1]), Some(fault));
        assert_eq!(parse(&[9, 1]), None);
    }

    #[test]
    fn an_orientation_is_read_and_believed_within_a_percent_of_a_unit() {
        let read = |quaternion: [i16; 4]| {
            let mut payload = vec![5, 0x34, 0x12];
            for component in quaternion {
                payload.extend(component.to_le_bytes());
            }
            let Some(Message::Orientation(orientation)) = parse(&payload) else {
                panic!("ORIENTATION not understood");
            };
            assert_eq!(
                (orientation.sequence, orientation.quaternion),
                (0x1234, quaternion)
            );
            payload.push(0);
            assert_eq!(parse(&payload), None);
            orientation.rotation()
        };
        // A quarter turn about z takes x to y.
        let half = 23_170;
        let turned = read([half, 0, 0, half]).expect("a unit quaternion");
        assert!((turned * DVec3::X).distance(DVec3::Y) < 1e-12);
        assert!((turned.length() - 1.0).abs() < 1e-15);
        for (length, believed) in [(32_439, false), (32_440, true), (0, false)] {
            assert_eq!(read([0, 0, -length, 0]).is_some(), believed, "{length}");
        }
        // The longest, 33094, is no whole number of steps in more than one direction.
        assert!(read([0, 26_000, 0, 20_474]).is_some());
        assert!(read([0, 26_000, 0, 20_475]).is_none());
        assert!(read([i16::MIN, 0, 0, 0]).is_some());
        assert!(read([i16::MIN; 4]).is_none());
    }

    #[test]
    fn errors_are_told_apart_and_the_next_frame_is_found() {
        let good = frame(&[2, 3]);
        let mut bytes = vec![1; 100];
        bytes.push(0);
        bytes.extend([9, 1, 0]);
        let mut damaged = good.clone();
        damaged[1] ^= 0x10;
        bytes.extend(&damaged);
        bytes.extend(&good);
        let (payloads, errors) = decode_all(&bytes);
        assert_eq!(payloads, [vec![2, 3]]);
        let expected = DecodeErrors {
            crc: 1,
            cobs: 1,
            oversize: 1,
        };
        assert_eq!(errors, expected);
    }

    proptest! {
        #[test]
        fn what_is_encoded_is_decoded(
            payloads in prop::collection::vec(
                prop::collection::vec(any::<u8>(), 1..=MAX_PAYLOAD), 0..8)
        ) {
            let bytes: Vec<u8> = payloads.iter().flat_map(|p| frame(p)).collect();
            prop_assert_eq!(decode_all(&bytes), (payloads, DecodeErrors::default()));
        }

        #[test]
        fn noise_never_panics_and_costs_at_most_one_frame(
            noise in prop::collection::vec(any::<u8>(), 0..400)
        ) {
            let mut bytes = noise;
            bytes.push(0);
            bytes.extend(frame(&[2, 0, 7]));
            let (payloads, _) = decode_all(&bytes);
            prop_assert_eq!(payloads.last(), Some(&vec![2, 0, 7]));
            for payload in &payloads {
                let _ = parse(payload);
            }
        }
    }
}
