"""The firmware's codec: the shared vectors both ways, and the other codecs on the same bytes."""

import re
import struct
import subprocess
from pathlib import Path

import pytest
from link_vectors import VECTORS
from palpate_servo import harness

from palpate.core.servo import link

REPOSITORY = Path(__file__).resolve().parents[2]


def hexed(data):
    return data.hex() or "-"


def words_of(vector):
    """A vector's message as the checker writes it."""
    fields = vector["fields"]

    def told(*names):
        return [fields[name] for name in names if name in fields]

    match vector["direction"], vector["type"]:
        case "host to device", "hello":
            return ["host-hello", fields["protocol"]]
        case "device to host", "hello":
            return [
                "device-hello",
                fields["protocol"],
                fields["name"].encode().ljust(16, b"\0").hex(),
                fields["axes"],
                fields["largest_force"],
                *fields["half_extents"],
                fields["rate_hz"],
                *told("largest_damping"),
            ]
        case _, "state":
            numbers = fields["sequence"], fields["device_time_us"], *fields["position_um"]
            return ["state", *numbers, fields["buttons"], fields["flags"], *told("taken")]
        case _, "force":
            answer = told("state_time_us", "age", "damping")
            return ["force", fields["sequence"], *fields["force_mn"], fields["flags"], *answer]
        case _, "fault":
            return ["fault", fields["code"], fields["detail"]]
        case _, "orientation":
            return ["orientation", fields["sequence"], *fields["quaternion"]]
    raise AssertionError(vector)


def numbers_in(words):
    """Words with numbers as numbers, so that 3 and 3.0 are the same; the name stays a text."""
    return [
        word if i in {0, 2} and "-hello" in str(words[0]) else _number(word)
        for i, word in enumerate(words)
    ]


def _number(word):
    try:
        return float(word)
    except ValueError:
        return word


def read_stream(checker, data):
    *payloads, crc_errors, malformed = checker.ask(f"stream {hexed(data)}").split()
    return payloads, int(crc_errors), int(malformed)


@pytest.mark.parametrize("vector", VECTORS["crc"], ids=lambda vector: vector["bytes"][:12])
def test_checksums_are_those_of_the_vectors(checker, vector):
    assert checker.ask(f"crc {vector['bytes'] or '-'}") == vector["crc"]


@pytest.mark.parametrize("vector", VECTORS["cobs"], ids=lambda vector: vector["plain"][:12])
def test_stuffing_is_that_of_the_vectors_both_ways(checker, vector):
    assert checker.ask(f"stuff {vector['plain'] or '-'}") == vector["coded"]
    assert checker.ask(f"unstuff {vector['coded']}") == (vector["plain"] or "-")


@pytest.mark.parametrize("vector", VECTORS["messages"], ids=lambda vector: vector["name"])
def test_messages_are_those_of_the_vectors_both_ways(checker, vector):
    words = words_of(vector)
    assert checker.ask(f"frame {vector['payload']}") == vector["frame"]
    assert checker.ask(" ".join(map(str, ["pack", *words]))) == vector["frame"]
    payloads, *errors = read_stream(checker, bytes.fromhex(vector["frame"]))
    assert (payloads, errors) == ([vector["payload"]], [0, 0])
    read = checker.ask(f"unpack {vector['payload']}").split()
    assert numbers_in(read) == numbers_in(words)


@pytest.mark.parametrize("vector", VECTORS["streams"], ids=lambda vector: vector["name"])
def test_streams_are_read_as_the_vectors_say(checker, vector):
    expected = (vector["payloads"], vector["crc_errors"], vector["malformed"])
    assert read_stream(checker, bytes.fromhex(vector["bytes"])) == expected


def test_what_is_no_message_is_not_read_as_one(checker):
    for vector in VECTORS["messages"]:
        payload = bytes.fromhex(vector["payload"])
        for wrong in (payload[:-1], payload + b"\0"):
            assert checker.ask(f"unpack {hexed(wrong)}") == "unknown"
    assert checker.ask("unpack 0901") == "unknown"
    # Of another protocol the first two bytes are read, whatever follows.
    assert checker.ask("unpack 01070102030405") == "host-hello 7"


@pytest.mark.parametrize("vector", VECTORS["refused"], ids=lambda vector: vector["name"])
def test_what_is_no_orientation_is_refused(checker, vector):
    assert checker.ask(f"unpack {vector['payload']}") == "unknown"


@pytest.mark.parametrize("figure", [-1.0, float("nan"), float("inf")])
@pytest.mark.parametrize("place", range(4))
def test_a_greeting_with_impossible_figures_is_refused(checker, figure, place):
    figures = [1.0, 0.1, 0.1, 0.1]
    figures[place] = figure
    payload = struct.pack("<BB16sB4fH", 1, 1, b"odd", 3, *figures, 1000)
    assert checker.ask(f"unpack {payload.hex()}") == "unknown"


@pytest.mark.parametrize("size", [0, 59])
def test_payloads_that_fit_no_frame_are_refused(checker, size):
    assert checker.ask(f"frame {hexed(bytes(size))}") == "-"


def test_more_than_one_cobs_block_is_refused(checker):
    assert checker.ask(f"stuff {bytes(253).hex()}") == "01" * 254
    assert checker.ask(f"stuff {bytes(254).hex()}") == "-"


@pytest.mark.parametrize("seed", [1, 2])
def test_a_million_bytes_of_noise_and_damage_do_no_harm(checker_program, seed):
    """No crash and no finding of the sanitizers; after each hit at most one more frame is lost."""
    done = subprocess.run(
        [checker_program, "fuzz", str(seed), "1000000"],
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    words = done.stdout.split()
    tally = dict(zip(words[::2], map(int, words[1::2]), strict=True))
    assert tally["bytes"] >= 1_000_000
    # The damage was of every kind, and the device lived through all of it.
    assert tally["damaged"] > 5_000
    assert tally["resynchronised"] > 1_000
    for name in ("crc_errors", "malformed", "unknown", "forces", "limp"):
        assert tally[name] > 20, tally


# --------------------------------------------------------------------------- docs/link.md

PROSE = (REPOSITORY / "docs/link.md").read_text(encoding="utf-8")
BYTES = re.compile(r"(?:[0-9A-F]{2} ?)+")


def worked_examples():
    """(title, payload, CRC, frame) of every example that shows all three."""
    found = []
    for section in PROSE.split("## Worked examples")[1].split("\n### ")[1:]:
        title, body = section.split("\n", 1)
        if "On the wire" not in body:
            continue
        fields, wire = body.split("\nCRC ", 1)
        rows = [line.strip() for line in fields.splitlines() if line.startswith("    ")]
        payload = b"".join(bytes.fromhex(BYTES.match(row)[0]) for row in rows)
        crc = int(wire[:4], 16)
        frame = next(line for line in wire.splitlines() if line.startswith("    "))
        found.append(pytest.param(payload, crc, bytes.fromhex(frame), wire, id=title))
    return found


def test_the_worked_examples_are_found():
    assert len(worked_examples()) == 14


@pytest.mark.parametrize(("payload", "crc", "frame", "prose"), worked_examples())
def test_worked_examples_are_right_to_the_byte(checker, payload, crc, frame, prose):
    assert link.crc16(payload) == crc
    assert checker.ask(f"crc {payload.hex()}") == f"{crc:04x}"
    low_first = crc.to_bytes(2, "little").hex(" ").upper()
    assert f"`{low_first}` is appended" in prose
    assert f"On the wire, {len(frame)} bytes" in prose
    assert link.frame(payload) == harness.encode_frame(payload) == frame
    assert checker.ask(f"frame {payload.hex()}") == frame.hex()
    assert read_stream(checker, frame) == ([payload.hex()], 0, 0)


def test_the_hit_between_two_frames_costs_both_and_not_the_next(checker):
    section = PROSE.split("### A hit between two frames costs both\n")[1]
    hit = bytes.fromhex(next(line for line in section.splitlines() if line.startswith("    ")))
    stream = hit + link.encode(link.Force(514, (0, -500, 1000)))
    expected = link.pack(link.Force(514, (0, -500, 1000)))
    python, native = link.Decoder(), harness.Decoder()
    assert python.feed_payloads(stream) == native.feed(stream) == [expected]
    assert (python.errors.crc_errors, python.errors.malformed) == (0, 1)
    assert (native.crc_errors, native.cobs_errors, native.oversize) == (0, 1, 0)
    assert read_stream(checker, stream) == ([expected.hex()], 0, 1)
