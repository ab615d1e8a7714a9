"""Frames of the link by the native codec, against the shared vectors and formulas."""

import json
from pathlib import Path

import pytest
from palpate_servo.harness import Decoder, encode_frame

VECTORS = Path(__file__).resolve().parents[2] / "vectors" / "link.json"


def crc16(data):
    """CRC-16/CCITT-FALSE bit by bit."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ (0x1021 if crc & 0x8000 else 0)) & 0xFFFF
    return crc


def cobs(data):
    """Consistent overhead byte stuffing of less than 254 bytes."""
    coded = b""
    for piece in data.split(b"\0"):
        coded += bytes([len(piece) + 1]) + piece
    return coded


def test_the_referee_has_the_check_value():
    assert crc16(b"123456789") == 0x29B1


@pytest.mark.parametrize("length", [1, 2, 10, 37, 57, 58])
def test_frames_are_cobs_of_payload_and_checksum(length):
    payload = bytes((7 * i) % 5 for i in range(length))
    expected = cobs(payload + crc16(payload).to_bytes(2, "little")) + b"\0"
    assert encode_frame(payload) == expected
    assert len(expected) <= 62
    assert Decoder().feed(expected) == [payload]


@pytest.mark.parametrize("length", [0, 59])
def test_payloads_that_do_not_fit_are_refused(length):
    with pytest.raises(ValueError, match="does not fit"):
        encode_frame(bytes(length))


def test_errors_are_told_apart():
    decoder = Decoder()
    good = encode_frame(b"\2abc")
    damaged = bytes([good[0], good[1] ^ 4, *good[2:]])
    assert decoder.feed(b"\1" * 80 + b"\0" + b"\x09\1\0" + damaged + good[:3]) == []
    assert decoder.feed(good[3:]) == [b"\2abc"]
    assert (decoder.crc_errors, decoder.cobs_errors, decoder.oversize) == (1, 1, 1)


@pytest.fixture(scope="module")
def vectors():
    return json.loads(VECTORS.read_text())


def test_messages_have_the_shared_frames(vectors):
    assert vectors["messages"]
    for message in vectors["messages"]:
        payload, frame = bytes.fromhex(message["payload"]), bytes.fromhex(message["frame"])
        assert encode_frame(payload) == frame, message["name"]
        assert Decoder().feed(frame) == [payload]


def test_streams_are_read_as_the_shared_vectors_say(vectors):
    assert vectors["streams"]
    for stream in vectors["streams"]:
        decoder = Decoder()
        payloads = decoder.feed(bytes.fromhex(stream["bytes"]))
        assert [p.hex() for p in payloads] == stream["payloads"], stream["name"]
        malformed = decoder.cobs_errors + decoder.oversize
        assert (decoder.crc_errors, malformed) == (stream["crc_errors"], stream["malformed"])
