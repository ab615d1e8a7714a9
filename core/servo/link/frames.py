"""Frames of the link: COBS(payload + CRC) + 0x00, with CRC-16/CCITT-FALSE."""

from __future__ import annotations

import binascii
import struct

MAX_FRAME = 62
"""Longest frame on the wire in bytes, with the closing zero."""
MAX_PAYLOAD = MAX_FRAME - 4
"""Longest payload in bytes: a frame adds the COBS code, two of CRC and the zero."""


class LinkError(ValueError):
    """Invalid bytes, or a message that does not fit its fields."""


def crc16(payload: bytes) -> int:
    """CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, no reflection, no final xor."""
    return binascii.crc_hqx(payload, 0xFFFF)


def cobs_encode(plain: bytes) -> bytes:
    """`plain` (at most 253 bytes) without any zero byte, one byte longer."""
    if len(plain) >= 0xFE:
        raise LinkError(f"{len(plain)} bytes are more than the one COBS block this link uses")
    return b"".join(bytes([len(run) + 1]) + run for run in plain.split(b"\0"))


def cobs_decode(coded: bytes) -> bytes:
    """Inverse of `cobs_encode`; raises LinkError when a code points past the end, and for zeros."""
    if 0 in coded:
        raise LinkError(f"a zero at byte {coded.index(0)} of {len(coded)}: COBS has none")
    runs: list[bytes] = []
    start = 0
    while start < len(coded):
        end = start + coded[start]
        if end > len(coded):
            raise LinkError(f"COBS code {coded[start]} at byte {start} of {len(coded)}")
        runs.append(coded[start + 1 : end])
        start = end
    return b"\0".join(runs)


def frame(payload: bytes) -> bytes:
    """Bytes on the wire for a payload of 1 to 58 bytes."""
    if not 1 <= len(payload) <= MAX_PAYLOAD:
        raise LinkError(f"a payload has 1 to {MAX_PAYLOAD} bytes, not {len(payload)}")
    return cobs_encode(payload + struct.pack("<H", crc16(payload))) + b"\0"
