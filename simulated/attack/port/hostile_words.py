"""What a hostile host says after sound forces: none of it counts as heard, or all of it does."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, replace

from ....core.servo import link
from .conversation import Conversation

OLD_US = (21_000, 2_000_000)
"""A force that answers so old a STATE is refused, us."""

Words = Callable[[Conversation], bytes]


@dataclass(frozen=True)
class Attack:
    """Bytes to say every few milliseconds."""

    name: str
    words: Words
    is_heard: bool = False
    """Whether the device must take it for a valid FORCE."""
    only_second: bool = False
    """Only in protocol 2."""
    heard_when_limp: bool = False
    """After silence a device takes it: the next FORCE, whatever its number."""


def _nothing(_: Conversation) -> bytes:
    return b""


def _cut(talk: Conversation) -> bytes:
    frame = talk.force()
    return frame[: talk.dice.randrange(1, len(frame) - 1)] + b"\0"


def _flipped(talk: Conversation) -> bytes:
    frame = bytearray(talk.force())
    at = talk.dice.randrange(len(frame) - 1)
    bit = 1 << talk.dice.randrange(8)
    frame[at] ^= bit if frame[at] != bit else 0xFF ^ bit
    return bytes(frame)


def _duplicate(talk: Conversation) -> bytes:
    return link.encode(talk.same_force())


def _late(talk: Conversation) -> bytes:
    back = talk.dice.randint(1, 30_000)
    force = talk.same_force()
    return link.encode(replace(force, sequence=(force.sequence - back) % link.SEQUENCES))


def _old(talk: Conversation) -> bytes:
    talk.sequence = (talk.sequence + 1) % link.SEQUENCES
    return link.encode(talk.same_force(answers_us_ago=talk.dice.randint(*OLD_US)))


def _of_the_other_protocol(talk: Conversation) -> bytes:
    talk.sequence = (talk.sequence + 1) % link.SEQUENCES
    force = talk.same_force()
    answer = None if force.answer is not None else link.Answer(talk.device_time)
    return link.encode(replace(force, answer=answer))


def _noise(talk: Conversation) -> bytes:
    return talk.dice.randbytes(talk.dice.randint(1, 1500)) + b"\0"


def _unknown(talk: Conversation) -> bytes:
    kind = talk.dice.choice([0, *range(6, 256)])
    return link.frame(bytes([kind]) + talk.dice.randbytes(talk.dice.randint(1, 50)))


def _of_a_device(talk: Conversation) -> bytes:
    """Messages that only devices send."""
    hello = link.pack(replace(talk.hello, largest_force=1e9)) if talk.hello else b""
    state = link.State(talk.dice.randrange(1 << 16), 0, (0, 0, 0))
    return link.frame(hello) + link.encode(state) + link.encode(link.Fault(128, 0))


def _too_long(talk: Conversation) -> bytes:
    """A sound FORCE, and more behind it under the same checksum."""
    talk.sequence = (talk.sequence + 1) % link.SEQUENCES
    payload = link.pack(talk.same_force())
    return link.frame(payload + talk.dice.randbytes(talk.dice.choice([1, 3, 20])))


def _odd_hello(talk: Conversation) -> bytes:
    return link.frame(struct.pack("<BBH", 1, talk.hello.protocol if talk.hello else 1, 7))


def _burst(talk: Conversation) -> bytes:
    return b"".join(talk.force() for _ in range(talk.dice.randint(2, 16)))


def _gaps(talk: Conversation) -> bytes:
    return talk.force(talk.dice.randint(2, 32_000))


def _between(bad: Words) -> Words:
    """Sound forces between what is not."""

    def words(talk: Conversation) -> bytes:
        junk = bad(talk)
        return b"\0" + junk + b"\0" + talk.force()

    return words


def _padded(talk: Conversation) -> bytes:
    return bytes(talk.dice.randint(1, 200)) + talk.force() + bytes(3)


ATTACKS = (
    Attack("silence", _nothing),
    Attack("only cut frames", _cut),
    Attack("only frames with a flipped bit", _flipped),
    Attack("the last FORCE again and again", _duplicate, heard_when_limp=True),
    Attack("only FORCE that are late", _late, heard_when_limp=True),
    Attack("only FORCE to STATE 21 ms to 2 s old", _old, only_second=True),
    Attack("only FORCE of the other protocol", _of_the_other_protocol),
    Attack("only noise", _noise),
    Attack("only messages of unknown type", _unknown),
    Attack("only what devices say", _of_a_device),
    Attack("only FORCE with more behind it", _too_long),
    Attack("only HELLO of a wrong length", _odd_hello),
    Attack("bursts of FORCE", _burst, is_heard=True),
    Attack("numbers that leap ahead", _gaps, is_heard=True),
    Attack("noise between FORCE", _between(_noise), is_heard=True),
    Attack("damage between FORCE", _between(_flipped), is_heard=True),
    Attack("zeros between FORCE", _padded, is_heard=True),
)
