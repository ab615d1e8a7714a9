"""An image that was changed after it was signed is found, as arm64's kernel would."""

from __future__ import annotations

import hashlib
import struct

import pytest
from servo_wheel.code_signature import signature_fault
from servo_wheel.mach_o import PROGRAM

PAGE = 4096


def signed(body: bytes) -> bytes:
    """A Mach-O image of one load command, with its signature behind `body`."""
    place = 32 + 16 + len(body)
    head = struct.pack("<8I", 0xFEEDFACF, 0x0100000C, 0, 6, 1, 16, 0, 0)
    command = struct.pack("<4I", 0x1D, 16, place, 0)
    image = head + command + body
    hashes = b"".join(
        hashlib.sha256(image[at : at + PAGE]).digest() for at in range(0, len(image), PAGE)
    )
    identity = b"palpate\0"
    at_hashes = 44 + len(identity)
    directory = struct.pack(
        ">9I4BI",
        *(0xFADE0C02, at_hashes + len(hashes), 0x20001, 2, at_hashes, 44, 0),
        *(len(hashes) // 32, len(image), 32, 2, 0, 12, 0),
    )
    directory += identity + hashes
    blob = struct.pack(">5I", 0xFADE0CC0, 20 + len(directory), 1, 0, 20) + directory
    return image + blob


@pytest.mark.parametrize("length", [100, PAGE - 48, 3 * PAGE, 3 * PAGE + 1])
def test_a_signed_image_has_no_fault(length):
    assert signature_fault(signed(b"x" * length)) is None


@pytest.mark.parametrize("at", [60, PAGE, 2 * PAGE + 17])
def test_one_changed_byte_is_found_with_its_page(at):
    image = bytearray(signed(b"x" * 3 * PAGE))
    image[at] ^= 1
    assert signature_fault(bytes(image)) == f"page {at // PAGE} was changed after it was signed"


def test_an_image_without_a_signature_is_told():
    unsigned = struct.pack("<8I", 0xFEEDFACF, 0x0100000C, 0, 6, 1, 16, 0, 0)
    unsigned += struct.pack("<4I", 0x2A, 16, 0, 0)
    assert signature_fault(unsigned) == "it is not signed"


def test_a_signature_that_ends_early_is_told():
    image = bytearray(signed(b"x" * 3 * PAGE))
    start = image.index(struct.pack(">I", 0xFADE0C02))
    struct.pack_into(">I", image, start + 32, PAGE)
    assert signature_fault(bytes(image)) == "its signature covers another length"


def test_a_magic_number_in_code_is_no_program():
    in_code = b"\x81\x3f\xcf\xfa\xed\xfe\x75\x10" + bytes(20)
    assert PROGRAM.search(in_code) is None
    program = struct.pack("<8I", 0xFEEDFACF, 0x01000007, 3, 2, 0, 0, 0, 0)
    assert PROGRAM.search(in_code + program).start() == len(in_code)
    library = struct.pack("<8I", 0xFEEDFACF, 0x01000007, 3, 6, 0, 0, 0, 0)
    assert PROGRAM.search(library) is None
