"""The signature of a Mach-O image: hashes that arm64 compares with a page before it runs it."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterator

LC_CODE_SIGNATURE = 0x1D
CODE_DIRECTORY = 0xFADE0C02
SHA256 = 2


def signature_fault(image: bytes) -> str | None:
    """Return what is wrong with the code signature of a 64-bit image; None if it holds.

    An ad hoc signature has no signer: it is a table of hashes (Apple, `cs_blobs.h`).
    """
    place = signature_place(image)
    if place is None:
        return "it is not signed"
    directory = _code_directory(image, place)
    if directory is None:
        return "its signature has no code directory"
    # magic, length, version, flags, hashOffset, identOffset, nSpecialSlots, nCodeSlots, codeLimit,
    # then the size and kind of a hash, the platform, and the page's size as a power of two.
    _, _, _, slots, limit = struct.unpack_from(">5I", image, directory + 16)
    _, kind, _, power = struct.unpack_from(">4B", image, directory + 36)
    if kind != SHA256 or limit > place:
        return "its signature is of an unknown kind"
    if slots != -(-limit // (1 << power)):
        return "its signature covers another length"
    for page, (start, digest) in enumerate(_hashes(image, directory)):
        if digest != image[start : start + len(digest)]:
            return f"page {page} was changed after it was signed"
    return None


def signed_anew(image: bytes) -> bytes:
    """Return a signed image with the hashes of its pages as they are now."""
    place = signature_place(image)
    directory = None if place is None else _code_directory(image, place)
    if directory is None:
        raise ValueError("the image has no signature that could be renewed")
    signed = bytearray(image)
    for start, digest in _hashes(image, directory):
        signed[start : start + len(digest)] = digest
    return bytes(signed)


def _hashes(image: bytes, directory: int) -> Iterator[tuple[int, bytes]]:
    """Yield of each page where its hash is written, and what it should be."""
    hashes, _, _, slots, limit = struct.unpack_from(">5I", image, directory + 16)
    size, _, _, power = struct.unpack_from(">4B", image, directory + 36)
    page = 1 << power
    for slot in range(slots):
        piece = image[slot * page : min((slot + 1) * page, limit)]
        yield directory + hashes + slot * size, hashlib.sha256(piece).digest()[:size]


def commands(image: bytes) -> Iterator[tuple[int, int]]:
    """Yield kind and place of each load command of a 64-bit image."""
    (count,) = struct.unpack_from("<I", image, 16)
    at = 32
    for _ in range(count):
        kind, length = struct.unpack_from("<II", image, at)
        yield kind, at
        at += length


def signature_place(image: bytes) -> int | None:
    """Return where the signature begins, by the load commands; None without one."""
    for kind, at in commands(image):
        if kind == LC_CODE_SIGNATURE:
            (place,) = struct.unpack_from("<I", image, at + 8)
            return int(place)
    return None


def _code_directory(image: bytes, place: int) -> int | None:
    """Where a signature's code directory begins: magic, length, count, then kinds and places."""
    (count,) = struct.unpack_from(">I", image, place + 8)
    for index in range(count):
        _, offset = struct.unpack_from(">II", image, place + 12 + 8 * index)
        if struct.unpack_from(">I", image, place + offset) == (CODE_DIRECTORY,):
            return place + int(offset)
    return None
