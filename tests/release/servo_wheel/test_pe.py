"""The guardian in an image for Windows is found by its two heads."""

from __future__ import annotations

import struct

import pytest
from servo_wheel.pe import PLACE_OF_HEAD, holds_a_program

PROGRAM = b"MZ".ljust(PLACE_OF_HEAD) + struct.pack("<I", 120) + b" " * 56 + b"PE\0\0"
REST = b"y" * 1000


def test_a_program_within_is_found():
    assert holds_a_program(PROGRAM + REST + PROGRAM + REST)


@pytest.mark.parametrize("within", [b"", b"MZ", PROGRAM[:-1], PROGRAM[:70]])
def test_the_image_itself_and_letters_alone_are_none(within):
    assert not holds_a_program(PROGRAM + REST + within + REST)
    assert not holds_a_program(PROGRAM + REST + within)
