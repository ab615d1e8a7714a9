//! `docs/link.md` by the word: each worked example, field by field and byte by byte.

use glam::DVec3;
use palpate_servo::device::Greeting;
use palpate_servo::device::link::codec::{Decoder, MAX_FRAME, checksum, encode};
use palpate_servo::device::link::messages::{
    Answer, DeviceOrientation, DeviceState, FIRST_PROTOCOL, Message, Taken, answering_payload,
    force_payload, hello_payload, parse,
};

const PAGE: &str = include_str!("../../../docs/link.md");

/// The bytes at the beginning of a line; what follows them tells what they are.
fn bytes(line: &str) -> Vec<u8> {
    line.split_whitespace()
        .map_while(|word| match word.len() {
            2 => u8::from_str_radix(word, 16).ok(),
            _ => None,
        })
        .collect()
}

fn section(title: &str) -> &'static str {
    let after = PAGE.split(&format!("\n### {title}\n")).nth(1);
    let section = after.unwrap_or_else(|| panic!("no section {title:?}"));
    section.split("\n### ").next().unwrap()
}

/// Payload and frame of an example that shows both, checked against each other.
fn example(title: &str) -> Vec<u8> {
    let (fields, wire) = section(title)
        .split_once("\nCRC ")
        .expect("fields, then CRC");
    let shown = |text: &'static str| text.lines().filter(|line| line.starts_with("    "));
    let payload: Vec<u8> = shown(fields).flat_map(bytes).collect();
    let frame = bytes(shown(wire).next().expect("a frame"));
    assert_eq!(
        checksum(&payload),
        u16::from_str_radix(&wire[..4], 16).unwrap()
    );
    assert_eq!(framed(&payload), frame, "{title}");
    let mut decoder = Decoder::default();
    let read: Vec<_> = frame
        .iter()
        .filter_map(|&b| decoder.push(b).map(<[u8]>::to_vec))
        .collect();
    assert_eq!(read, std::slice::from_ref(&payload));
    payload
}

fn framed(payload: &[u8]) -> Vec<u8> {
    let mut frame = [0; MAX_FRAME];
    let length = encode(payload, &mut frame).unwrap();
    frame[..length].to_vec()
}

fn simulated() -> Message {
    Message::Hello(Greeting {
        protocol: FIRST_PROTOCOL,
        name: *b"Simulated\0\0\0\0\0\0\0",
        axes: 3,
        max_force: 3.0,
        half_extents: [0.125, 0.125, 0.0625],
        rate_hz: 1000,
        largest_damping: 0.0,
    })
}

fn on_its_way(sequence: u16, time_us: u32) -> DeviceState {
    DeviceState {
        sequence,
        time_us,
        position_um: [12_345, -6_789, 30_000],
        buttons: 0,
        ready: true,
        fault: false,
        taken: None,
    }
}

const PUSH: DVec3 = DVec3::new(0.0, -0.5, 1.0);

#[test]
fn the_hosts_examples_are_what_the_host_says() {
    assert_eq!(example("The host asks who is there"), hello_payload(1));
    assert_eq!(
        example("A newton up, half a newton back"),
        force_payload(513, PUSH, true)
    );
    assert_eq!(
        example("The host lets go"),
        force_payload(514, DVec3::ZERO, false)
    );
}

#[test]
fn the_devices_examples_are_read_field_by_field() {
    let ailing = DeviceState {
        buttons: 1,
        ready: false,
        fault: true,
        ..on_its_way(259, 2000)
    };
    for (title, message) in [
        ("A device answers", simulated()),
        ("A device on its way", Message::State(on_its_way(258, 1000))),
        (
            "The device has gone limp for the third time",
            Message::Fault { code: 1, detail: 3 },
        ),
        ("A device with a fault of its own", Message::State(ailing)),
        (
            "The host spoke protocol 7",
            Message::Fault { code: 2, detail: 7 },
        ),
        (
            "A stylus tilted by 30 degrees",
            Message::Orientation(DeviceOrientation {
                sequence: 258,
                quaternion: [31_650, 8_481, 0, 0],
            }),
        ),
    ] {
        assert_eq!(parse(&example(title)), Some(message), "{title}");
    }
}

#[test]
fn the_examples_of_protocol_2_are_what_the_host_says_and_reads() {
    assert_eq!(example("The host asks in protocol 2"), hello_payload(2));
    let answer = Answer {
        time_us: 1000,
        age: 0.25e-3,
        damping: 0.0,
    };
    assert_eq!(
        example("A newton up, in answer to a STATE"),
        answering_payload(force_payload(513, PUSH, true), &answer)
    );
    let brakes = Answer {
        time_us: 2000,
        age: 0.0,
        damping: 20.0,
    };
    assert_eq!(
        example("No force, but brake"),
        answering_payload(force_payload(514, DVec3::ZERO, false), &brakes)
    );
    let Message::Hello(older) = simulated() else {
        unreachable!("it is a HELLO")
    };
    let hello = Message::Hello(Greeting {
        protocol: 2,
        largest_damping: 20.0,
        ..older
    });
    assert_eq!(
        parse(&example("A device answers in protocol 2")),
        Some(hello)
    );
    let named = Message::State(DeviceState {
        taken: Some(Taken::Force(513)),
        ..on_its_way(259, 2000)
    });
    assert_eq!(parse(&example("A device that took it")), Some(named));
}

#[test]
fn no_example_is_left_out() {
    let examples = PAGE.split("## Worked examples").nth(1).unwrap();
    assert_eq!(examples.matches("\nCRC ").count(), 14);
    assert_eq!(examples.matches("\n### ").count(), 16);
}

#[test]
fn the_conversation_is_what_both_say() {
    let mut said = Vec::new();
    for line in section("A conversation").lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [time, speaker @ ("host" | "device"), rest @ ..] = &words[..] else {
            continue;
        };
        let mut decoder = Decoder::default();
        for byte in bytes(&rest.join(" ")) {
            if let Some(payload) = decoder.push(byte) {
                said.push((time.parse::<u32>().unwrap(), *speaker, payload.to_vec()));
            }
        }
        assert_eq!(decoder.errors, Default::default());
    }
    let host: Vec<_> = said
        .iter()
        .filter(|(_, speaker, _)| *speaker == "host")
        .collect();
    let force = |sequence| force_payload(sequence, PUSH, true).to_vec();
    let expected = [
        (0, hello_payload(1).to_vec()),
        (1_200, force(65_535)),
        (2_200, force(0)),
        (2_300, force(0)),
        (40_000, force(7)),
        (41_000, vec![1, 7]),
    ];
    assert_eq!(host.len(), expected.len());
    for ((time, _, payload), (when, what)) in host.into_iter().zip(expected) {
        assert_eq!((*time, payload), (when, &what));
    }
    let device: Vec<_> = said
        .iter()
        .filter(|(_, speaker, _)| *speaker == "device")
        .map(|(time, _, payload)| (*time, parse(payload).expect("a message")))
        .collect();
    let state = |sequence, time_us| (time_us, Message::State(on_its_way(sequence, time_us)));
    let limp = Message::Fault { code: 1, detail: 1 };
    let other = Message::Fault { code: 2, detail: 7 };
    let expected = [
        (0, simulated()),
        state(0, 1_000),
        state(1, 2_000),
        (22_200, limp),
        state(2, 23_000),
        (41_000, simulated()),
        (41_000, other),
    ];
    assert_eq!(device, expected);
}

#[test]
fn a_hit_between_two_frames_costs_both_and_not_the_next() {
    let mut decoder = Decoder::default();
    let line = section("A hit between two frames costs both")
        .lines()
        .find(|line| line.starts_with("    "))
        .expect("the bytes");
    assert!(bytes(line).iter().all(|&byte| decoder.push(byte).is_none()));
    assert_eq!((decoder.errors.cobs, decoder.errors.crc), (1, 0));
    let next = force_payload(514, PUSH, true);
    let read: Vec<_> = framed(&next)
        .iter()
        .filter_map(|&b| decoder.push(b).map(<[u8]>::to_vec))
        .collect();
    assert_eq!(read, [next.to_vec()]);
}
