"""The Python codec of the link: what goes in comes out, and nothing else does."""

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from link_vectors import VECTORS, bits, messages, rotations

from palpate.core.servo import link


def named(vectors):
    return {"argvalues": vectors, "ids": [vector["name"] for vector in vectors]}


def message_of(vector):
    fields = {
        name: tuple(value) if isinstance(value, list) else value
        for name, value in vector["fields"].items()
    }
    if "state_time_us" in fields:
        names = ("state_time_us", "age", "damping")
        fields["answer"] = link.Answer(*(fields.pop(name) for name in names))
    kinds = {
        ("host to device", "hello"): link.HostHello,
        ("device to host", "hello"): link.DeviceHello,
        ("device to host", "state"): link.State,
        ("host to device", "force"): link.Force,
        ("device to host", "fault"): link.Fault,
        ("device to host", "orientation"): link.Orientation,
    }
    return kinds[vector["direction"], vector["type"]](**fields)


@pytest.mark.parametrize("vector", VECTORS["crc"])
def test_checksum_of_the_vectors(vector):
    assert link.crc16(bytes.fromhex(vector["bytes"])) == int(vector["crc"], 16)


@given(st.binary(max_size=80))
def test_checksum_is_the_bitwise_definition(data):
    register = 0xFFFF
    for byte in data:
        register ^= byte << 8
        for _ in range(8):
            register = register << 1 ^ (0x1021 if register & 0x8000 else 0)
            register &= 0xFFFF
    assert link.crc16(data) == register


@pytest.mark.parametrize("vector", VECTORS["cobs"])
def test_cobs_of_the_vectors(vector):
    plain, coded = bytes.fromhex(vector["plain"]), bytes.fromhex(vector["coded"])
    assert link.cobs_encode(plain) == coded
    assert link.cobs_decode(coded) == plain


@given(st.binary(max_size=253))
def test_cobs_has_no_zero_costs_one_byte_and_comes_back(plain):
    coded = link.cobs_encode(plain)
    assert 0 not in coded
    assert len(coded) == len(plain) + 1
    assert link.cobs_decode(coded) == plain


@example(b"\x03\x00\x00")
@given(st.binary(max_size=80))
def test_cobs_decodes_only_what_it_would_have_encoded(coded):
    try:
        plain = link.cobs_decode(coded)
    except link.LinkError:
        return
    assert link.cobs_encode(plain) == coded or coded == b""


def test_more_than_one_cobs_block_is_refused():
    with pytest.raises(link.LinkError, match="254 bytes"):
        link.cobs_encode(bytes(254))


@pytest.mark.parametrize("vector", **named(VECTORS["messages"]))
def test_messages_are_the_bytes_of_the_vectors(vector):
    message, payload = message_of(vector), bytes.fromhex(vector["payload"])
    assert link.pack(message) == payload
    assert link.crc16(payload) == int(vector["crc"], 16)
    assert link.encode(message).hex() == vector["frame"]
    assert link.Decoder().feed(bytes.fromhex(vector["frame"])) == [message]


@pytest.mark.parametrize("vector", **named(VECTORS["streams"]))
@pytest.mark.parametrize("piece", [1, 7, 10_000])
def test_streams_decode_as_the_vectors_say_in_pieces_of_any_size(vector, piece):
    data = bytes.fromhex(vector["bytes"])
    decoder = link.Decoder()
    payloads = [
        payload
        for start in range(0, len(data), piece)
        for payload in decoder.feed_payloads(data[start : start + piece])
    ]
    assert [payload.hex() for payload in payloads] == vector["payloads"]
    assert decoder.errors.crc_errors == vector["crc_errors"]
    assert decoder.errors.malformed == vector["malformed"]


@given(st.lists(messages, max_size=8), st.randoms(use_true_random=False))
def test_messages_come_back_however_the_bytes_are_cut(sent, random):
    data = b"".join(map(link.encode, sent))
    decoder, received = link.Decoder(), []
    while data:
        cut = random.randint(1, len(data))
        received += decoder.feed(data[:cut])
        data = data[cut:]
    assert received == sent
    assert decoder.errors.total == 0


@given(messages)
def test_no_frame_is_longer_than_promised(message):
    frame = link.encode(message)
    assert len(frame) <= link.MAX_FRAME
    assert frame.index(0) == len(frame) - 1


@given(messages, st.data())
def test_up_to_three_flipped_bits_never_pass_for_a_message(message, data):
    """The polynomial has Hamming distance 4 at these lengths; COBS may turn a flip of a code byte
    into more, so only flips that leave the framing alone are sure to be caught."""
    payload = link.pack(message)
    checked = bytearray(payload + link.crc16(payload).to_bytes(2, "little"))
    places = data.draw(
        st.sets(st.integers(0, 8 * len(checked) - 1), min_size=1, max_size=3), label="bits"
    )
    for place in places:
        checked[place // 8] ^= 1 << place % 8
    decoder = link.Decoder()
    assert decoder.feed_payloads(link.cobs_encode(bytes(checked)) + b"\0") == []
    assert decoder.errors.crc_errors == 1


@given(messages, messages, st.data())
def test_any_damage_inside_a_frame_is_over_with_the_next_zero(first, second, data):
    frame = bytearray(link.encode(first))
    place = data.draw(st.integers(0, len(frame) - 2))
    frame[place] = data.draw(bits(8))
    decoder = link.Decoder()
    assert decoder.feed(bytes(frame) + link.encode(second))[-1:] == [second]


@given(st.binary(max_size=400), messages)
def test_after_any_noise_the_first_frame_behind_a_zero_is_read(noise, message):
    decoder = link.Decoder()
    decoder.feed(noise)
    assert decoder.feed(b"\0" + link.encode(message))[-1:] == [message]


@given(st.lists(st.binary(max_size=90), max_size=30))
def test_every_frame_of_noise_is_counted_once(pieces):
    """Each run of bytes between zeros is a payload or exactly one error."""
    data = b"".join(piece + b"\0" for piece in pieces)
    decoder = link.Decoder()
    payloads = decoder.feed_payloads(data)
    runs = sum(1 for run in data.split(b"\0") if run)
    assert len(payloads) + decoder.errors.total == runs


@given(st.binary(min_size=1, max_size=link.MAX_PAYLOAD))
def test_a_sound_payload_without_a_meaning_is_counted_as_unknown(payload):
    decoder = link.Decoder()
    read = decoder.feed(link.frame(payload))
    assert len(read) + decoder.errors.unknown == 1
    assert decoder.errors.total == decoder.errors.unknown


def test_a_hello_of_another_protocol_is_told_from_nonsense():
    assert link.unpack(b"\x01\x07 and whatever version seven says") == link.OtherHello(7)
    assert link.unpack(b"\x01\x03") == link.OtherHello(3)


@pytest.mark.parametrize(
    "message",
    [
        link.Force(0, (0, 0, 40_000)),
        link.State(1 << 16, 0, (0, 0, 0)),
        link.DeviceHello("x", 3, 1e300, (0.0, 0.0, 0.0), 1000),
        link.OtherHello(2),
    ],
)
def test_numbers_that_do_not_fit_are_refused(message):
    with pytest.raises(link.LinkError):
        link.encode(message)


@pytest.mark.parametrize("force", [float("nan"), float("inf"), -1.0])
def test_a_hello_without_a_sensible_force_is_no_hello(force):
    payload = link.pack(link.DeviceHello("x", 3, force, (0.1, 0.1, 0.1), 1000))
    with pytest.raises(link.LinkError, match="negative or no number"):
        link.unpack(payload)


@pytest.mark.parametrize("vector", **named(VECTORS["refused"]))
def test_what_is_no_orientation_is_refused_and_counted(vector):
    decoder = link.Decoder()
    assert decoder.feed(link.frame(bytes.fromhex(vector["payload"]))) == []
    assert (decoder.errors.unknown, decoder.errors.total) == (1, 1)


@pytest.mark.parametrize("part", [float("nan"), float("inf"), 0.98, 1.02, 0.0])
def test_what_is_no_unit_quaternion_is_not_sent(part):
    with pytest.raises(link.LinkError, match="divide it by its length"):
        link.orientation(0, (part, 0.0, 0.0, 0.0))


def test_a_unit_quaternion_is_sent_as_the_document_shows():
    half = math.radians(15.0)
    tilted = (math.cos(half), math.sin(half), 0.0, 0.0)
    assert link.orientation(258, tilted) == link.Orientation(258, (31650, 8481, 0, 0))


@given(rotations)
def test_rounding_turns_a_stylus_by_less_than_its_document_says(unit):
    sent = link.orientation(0, unit).quaternion
    cosine = sum(a * b for a, b in zip(unit, sent, strict=True)) / math.hypot(*sent)
    # Of the part across: the arc cosine of nearly 1 is worthless.
    across = math.hypot(
        *(b / math.hypot(*sent) - cosine * a for a, b in zip(unit, sent, strict=True))
    )
    assert math.degrees(2.0 * math.asin(across)) < 0.0035


def test_long_names_are_cut_between_characters():
    hello = link.DeviceHello("fünfzehn Büchsen", 3, 1.0, (0.1, 0.1, 0.1), 1000)
    read = link.unpack(link.pack(hello))
    assert read.name == "fünfzehn Büchs"
