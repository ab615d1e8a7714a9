"""The signature of a Mach-O image: hashes that arm64 compares with a page before it runs it."""

from __future__ import annotations

import hashlib
import struct

LC_CODE_SIGNATURE = 0x1D
CODE_DIRECTORY = 0xFADE0C02
SHA256 = 2


def signature_fault(image: bytes) -> str | None:
    """Return what is wrong with the code signature of a 64-bit image; None if it holds.

    An ad hoc signature has no signer: it is a table of hashes (Apple, `cs_blobs.h`).
    """
    place = _place(image)
    if place is None:
        return "it is not signed"
    directory = _code_directory(image, place)
    if directory is None:
        return "its signature has no code directory"
    # magic, length, version, flags, hashOffset, identOffset, nSpecialSlots, nCodeSlots, codeLimit,
    # then the size and kind of a hash, the platform, and the page's size as a power of two.
    hashes, _, _, slots, limit = struct.unpack_from(">5I", image, directory + 16)
    size, kind, _, power = struct.unpack_from(">4B", image, directory + 36)
    if kind != SHA256 or limit > place:
        return "its signature is of an unknown kind"
    page = 1 << power
    if slots != -(-limit // page):
        return "its signature covers another length"
    for slot in range(slots):
        piece = image[slot * page : min((slot + 1) * page, limit)]
        start = directory + hashes + slot * size
        if hashlib.sha256(piece).digest()[:size] != image[start : start + size]:
            return f"page {slot} was changed after it was signed"
    return None


def _place(image: bytes) -> int | None:
    """Where the signature begins, by the load commands."""
    (count,) = struct.unpack_from("<I", image, 16)
    at = 32
    for _ in range(count):
        kind, length = struct.unpack_from("<II", image, at)
        if kind == LC_CODE_SIGNATURE:
            (place,) = struct.unpack_from("<I", image, at + 8)
            return int(place)
        at += length
    return None


def _code_directory(image: bytes, place: int) -> int | None:
    """Where a signature's code directory begins: magic, length, count, then kinds and places."""
    (count,) = struct.unpack_from(">I", image, place + 8)
    for index in range(count):
        _, offset = struct.unpack_from(">II", image, place + 12 + 8 * index)
        if struct.unpack_from(">I", image, place + offset) == (CODE_DIRECTORY,):
            return place + int(offset)
    return None
