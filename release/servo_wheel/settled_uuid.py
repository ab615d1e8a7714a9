"""Identities of Mach-O images by what is in them: the linker's also tell where they were made.

The linker numbers an image (LC_UUID) before names and paths of its making are taken out of it, so
two checkouts give two numbers, and two signatures. Here the number follows from what is left.
"""

from __future__ import annotations

import hashlib
import re
import struct
import zipfile
from pathlib import Path

from servo_wheel.code_signature import commands, signature_place, signed_anew
from servo_wheel.wheel_file import rewrite

LC_SEGMENT_64, LC_UUID = 0x19, 0x1B
MACH_O = re.compile(b"\xcf\xfa\xed\xfe[\x07\x0c]\x00\x00\x01.{4}[\x02\x06]\x00\x00\x00", re.DOTALL)
UUID_BYTES = 16


def settle_wheel(wheel: Path) -> None:
    """Settle the images in a wheel, and what its record says of them."""
    with zipfile.ZipFile(wheel) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    changed = {
        name: settled(content)
        for name, content in members.items()
        if MACH_O.match(content) is not None
    }
    rewrite(wheel, changed)


def settled(image: bytes) -> bytes:
    """Return an image with its number, and that of each image within it, by what is in them."""
    starts = [found.start() for found in MACH_O.finditer(image)]
    # Those within first: what they are is part of what is around them.
    for start in reversed(starts):
        image = image[:start] + _settled_alone(image[start:])
    return image


def _settled_alone(image: bytes) -> bytes:
    place = next((at + 8 for kind, at in commands(image) if kind == LC_UUID), None)
    if place is None:
        return image
    content = bytearray(image[: _end(image)])
    content[place : place + UUID_BYTES] = bytes(UUID_BYTES)
    signature = signature_place(image)
    number = bytearray(hashlib.sha256(content[:signature]).digest()[:UUID_BYTES])
    # Version 8 of RFC 9562, made as its maker likes.
    number[6] = number[6] & 0x0F | 0x80
    number[8] = number[8] & 0x3F | 0x80
    numbered = image[:place] + bytes(number) + image[place + UUID_BYTES :]
    return numbered if signature is None else signed_anew(numbered)


def _end(image: bytes) -> int:
    """Length of an image, by its segments."""
    ends = [0]
    for kind, at in commands(image):
        if kind == LC_SEGMENT_64:
            offset, length = struct.unpack_from("<2Q", image, at + 40)
            ends.append(offset + length)
    return max(ends)
