//! Frames and messages of the link, byte for byte.

use glam::DVec3;
use palpate_servo::device::link::codec::{
    DecodeErrors, Decoder, MAX_FRAME, MAX_PAYLOAD, checksum, encode,
};
use palpate_servo::device::link::messages::{
    Answer, DeviceState, Message, Taken, answering_payload, force_payload, hello_payload, parse,
};
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
    for protocol in [1, 2] {
        let sum = checksum(&[1, protocol]).to_le_bytes();
        let hello = frame(&hello_payload(protocol));
        assert_eq!(hello, [5, 1, protocol, sum[0], sum[1], 0]);
    }
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
fn a_force_of_protocol_2_says_what_it_answers_how_old_it_is_and_how_to_brake() {
    let force = force_payload(0x0102, DVec3::new(1.0, -0.5, 0.0004), true);
    let answer = Answer {
        time_us: 0x0403_0201,
        age: 1.5e-3,
        damping: 2.5,
    };
    let said = answering_payload(force, &answer);
    assert_eq!(said[..9], force[..9]);
    assert_eq!(said[9..], [3, 1, 2, 3, 4, 150, 0, 250, 0]);
    let old = Answer {
        age: 3.0,
        damping: 0.0,
        ..answer
    };
    let said = answering_payload(force, &old);
    assert_eq!(said[9..], [1, 1, 2, 3, 4, 0xFF, 0xFF, 0, 0]);
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
        taken: None,
    };
    assert_eq!(parse(&state), Some(Message::State(expected)));
    state.push(0x34);
    assert_eq!(parse(&state), None);
    state.push(0x12);
    for (flags, taken) in [(3, Taken::Nothing), (7, Taken::Force(0x1234))] {
        state[20] = flags;
        let expected = DeviceState {
            taken: Some(taken),
            ..expected
        };
        assert_eq!(parse(&state), Some(Message::State(expected)));
    }
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
    assert_eq!(greeting.largest_damping, 0.0);
    hello[1] = 2;
    assert_eq!(parse(&hello), None);
    hello.extend(250_u16.to_le_bytes());
    let Some(Message::Hello(greeting)) = parse(&hello) else {
        panic!("HELLO of protocol 2 not understood");
    };
    assert_eq!((greeting.protocol, greeting.largest_damping), (2, 2.5));
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
