"""Images that differ by their linker's number alone become the same, and stay signed."""

from __future__ import annotations

import base64
import hashlib
import struct
import zipfile

import pytest
from servo_wheel.code_signature import signature_fault
from servo_wheel.settled_uuid import settle_wheel, settled

PAGE = 4096
COMMANDS = 24 + 72 + 16


def image(number: bytes, body: bytes) -> bytes:
    """A signed library with a number, one segment and a body."""
    place = 32 + COMMANDS + len(body)
    head = struct.pack("<8I", 0xFEEDFACF, 0x0100000C, 0, 6, 3, COMMANDS, 0, 0)
    uuid = struct.pack("<2I", 0x1B, 24) + number
    segment = struct.pack("<2I16s4Q4I", 0x19, 72, b"__TEXT", 0, place, 0, place, 5, 5, 0, 0)
    content = head + uuid + segment + struct.pack("<4I", 0x1D, 16, place, 0) + body
    hashes = b"".join(
        hashlib.sha256(content[at : at + PAGE]).digest() for at in range(0, len(content), PAGE)
    )
    directory = struct.pack(
        ">9I4BI",
        *(0xFADE0C02, 44 + len(hashes), 0x20001, 2, 44, 44, 0),
        *(len(hashes) // 32, len(content), 32, 2, 0, 12, 0),
    )
    directory += hashes
    return content + struct.pack(">5I", 0xFADE0CC0, 20 + len(directory), 1, 0, 20) + directory


def library(outer: bytes, inner: bytes, text: bytes = b"x") -> bytes:
    """A library with a program within it, each with its number."""
    program = bytearray(image(inner * 16, text * PAGE))
    struct.pack_into("<I", program, 12, 2)
    return image(outer * 16, b"y" * 5000 + bytes(program) + b"z" * 100)


def test_the_numbers_follow_from_the_content_alone():
    one, other = settled(library(b"1", b"2")), settled(library(b"3", b"4"))
    assert one == other != settled(library(b"1", b"2", b"w"))
    assert signature_fault(one) is None
    assert settled(one) == one


@pytest.mark.parametrize("at", [32 + 8, 32 + COMMANDS + 5000 + 32 + 8], ids=["outer", "inner"])
def test_each_number_is_another_one_than_the_linkers(at):
    before = library(b"1", b"1")
    assert before[at : at + 16] == b"1" * 16
    assert settled(before)[at : at + 16] != b"1" * 16


def test_a_wheel_keeps_its_files_and_its_record_is_right(tmp_path):
    name, record = "a/a.abi3.so", "a-1.dist-info/RECORD"
    wheels = []
    for number in (b"1", b"2"):
        wheels.append(tmp_path / f"{number.decode()}.whl")
        with zipfile.ZipFile(wheels[-1], "w") as archive:
            archive.writestr(zipfile.ZipInfo(name), library(number, number))
            archive.writestr(zipfile.ZipInfo("a/__init__.py"), "")
            old = f"{name},sha256=old,3\na/__init__.py,sha256=kept,0\n{record},,\n"
            archive.writestr(zipfile.ZipInfo(record), old)
        settle_wheel(wheels[-1])
    assert wheels[0].read_bytes() == wheels[1].read_bytes()
    with zipfile.ZipFile(wheels[0]) as archive:
        content = archive.read(name)
        rows = archive.read(record).decode().splitlines()
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
    assert rows == [
        f"{name},sha256={digest},{len(content)}",
        "a/__init__.py,sha256=kept,0",
        f"{record},,",
    ]
