"""Three codecs on the same damaged streams; Rust reads them in `native/tests/device/fuzz_link.rs`.

Where there is no C++ compiler, Python and Rust still meet in `tests/core/devices`.
"""

import csv
import subprocess
from pathlib import Path

import pytest
from palpate_servo import harness

from palpate.core.servo import link

VECTORS = Path(__file__).resolve().parents[1] / "vectors" / "damage.csv"
LINES = VECTORS.read_text(encoding="ascii").splitlines()
SHARE = 300_000


def output(program, *arguments):
    command = [program, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, timeout=100, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    return done.stdout


@pytest.mark.parametrize("line", LINES[1:], ids=lambda line: f"seed {line.split(',')[0]}")
def test_cpp_reads_ten_million_bytes_of_damage_as_rust_does(checker_program, line):
    """To the byte: what was sent, what was read, what was wrong; no sound frame is lost."""
    assert output(checker_program, "read-damage", line.split(",")[0], 1_000_000).decode() == (
        line + "\n"
    )


def test_no_more_is_read_that_was_not_sent_than_a_checksum_of_16_bits_lets_through():
    rows = list(csv.DictReader(LINES))
    total = {
        name: sum(int(row[name]) for row in rows) for name in ("bytes", "crc_errors", "phantoms")
    }
    assert total["bytes"] >= 10_000_000
    expected = total["crc_errors"] / 2**16
    assert abs(total["phantoms"] - expected) < 5 * expected**0.5


@pytest.mark.parametrize("seed", [11, 12])
def test_python_reads_a_share_of_it_frame_by_frame_as_the_others_do(checker_program, checker, seed):
    stream = output(checker_program, "write-damage", seed, SHARE)
    python, native = link.Decoder(), harness.Decoder()
    payloads = python.feed_payloads(stream)
    assert native.feed(stream) == payloads
    errors = (python.errors.crc_errors, python.errors.malformed)
    assert (native.crc_errors, native.cobs_errors + native.oversize) == errors
    assert len(payloads) > 1_500
    # What C++ reads one by one; a request holds 64 KB.
    words = checker.ask(f"stream {stream[:60_000].hex()}").split()[:-2]
    assert words == [payload.hex() for payload in payloads[: len(words)]]
    assert len(words) > 300
    for payload in payloads:
        # Whatever is no message is told so, and nothing else is raised.
        try:
            link.unpack(payload)
        except link.LinkError:
            continue
