"""Codec of the link: messages to frames, and received bytes to messages."""

from __future__ import annotations

from dataclasses import dataclass

from .frames import MAX_FRAME, LinkError, cobs_decode, crc16, frame
from .messages import Message, pack, unpack


def encode(message: Message) -> bytes:
    """Frame of a message, ready for the wire."""
    return frame(pack(message))


@dataclass
class LinkErrors:
    """Frames rejected by a decoder, by reason."""

    crc_errors: int = 0
    malformed: int = 0
    """Frames with invalid COBS, too short for a type and a CRC, or too long."""
    unknown: int = 0
    """Frames with a right CRC, but no message of this version."""

    @property
    def total(self) -> int:
        """All rejected frames."""
        return self.crc_errors + self.malformed + self.unknown


class Decoder:
    """Decoder of bytes, in pieces of any size, to messages.

    Zero occurs on the wire only at the end of a frame, so damage costs one frame (two when the zero
    between them is hit) and decoding resumes with the next.
    """

    def __init__(self) -> None:
        self.errors = LinkErrors()
        self._begun = bytearray()
        self._too_long = False

    def feed(self, data: bytes) -> list[Message]:
        """Messages completed by `data`, in order; broken frames are counted and left out."""
        messages: list[Message] = []
        for payload in self.feed_payloads(data):
            try:
                messages.append(unpack(payload))
            except LinkError:
                self.errors.unknown += 1
        return messages

    def feed_payloads(self, data: bytes) -> list[bytes]:
        """Payloads completed by `data`, with checked CRC but unknown meaning."""
        payloads: list[bytes] = []
        *endings, rest = data.split(b"\0")
        for ending in endings:
            self._extend(ending)
            payload = self._finish()
            if payload is not None:
                payloads.append(payload)
        self._extend(rest)
        return payloads

    def _extend(self, piece: bytes) -> None:
        room = MAX_FRAME - 1 - len(self._begun)
        self._too_long = self._too_long or len(piece) > room
        self._begun += piece[:room]

    def _finish(self) -> bytes | None:
        coded, too_long = bytes(self._begun), self._too_long
        self._begun.clear()
        self._too_long = False
        if not coded:
            return None
        try:
            plain = b"" if too_long else cobs_decode(coded)
        except LinkError:
            plain = b""
        if len(plain) < 3:
            self.errors.malformed += 1
            return None
        payload, crc = plain[:-2], int.from_bytes(plain[-2:], "little")
        if crc16(payload) != crc:
            self.errors.crc_errors += 1
            return None
        return payload
