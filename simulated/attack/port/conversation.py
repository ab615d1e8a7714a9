"""A host at a port that may say anything, and remembers what the device answered."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random
from typing import Protocol

from ....core.errors import PalpateError
from ....core.servo import link

TIMES = 1 << 32
"""The device's time wraps, us."""
HELLO_EVERY = 0.1
ANSWER_SECONDS = 2.5
FORCE_EVERY = 0.004
LOOK_EVERY = 0.0005


class Port(Protocol):
    """What is asked of a `serial.Serial`."""

    @property
    def port(self) -> str | None:
        """Its name."""

    @property
    def in_waiting(self) -> int:
        """How many bytes can be read at once."""

    def read(self, size: int, /) -> bytes:
        """Bytes of the device, at most so many."""

    def write(self, data: bytes, /) -> int | None:
        """Hands bytes to the device."""


@dataclass
class Conversation:
    """What was said and heard at an open port; forces in mN.

    `largest_mn` is what is asked for at the most, in any direction; `now` and `wait` are its
    clock, s.
    """

    port: Port
    largest_mn: int
    dice: Random
    now: Callable[[], float] = time.monotonic
    wait: Callable[[float], None] = time.sleep
    hello: link.DeviceHello | None = None
    states: list[link.State] = field(default_factory=list)
    faults: list[tuple[link.Fault, int]] = field(default_factory=list)
    """With the number of STATE that were heard before it."""
    others: list[link.Message] = field(default_factory=list)
    sequence: int = 0
    """Of the last FORCE."""
    longest_pause: float = 0.0
    """Between two things that were said, or between two STATE that were heard, s."""
    _said_at: float = 0.0
    _heard_at: float = 0.0
    _decoder: link.Decoder = field(default_factory=link.Decoder)

    def greet(self, protocol: int = link.PROTOCOL) -> link.DeviceHello:
        """Say HELLO until the device answers; what was heard before is forgotten.

        Raises PalpateError if nothing that speaks a protocol of ours answers.
        """
        deadline = self.now() + ANSWER_SECONDS
        while self.now() < deadline:
            self.hello = None
            self.say(b"\0" + link.encode(link.HostHello(protocol)))
            self.listen(HELLO_EVERY, self.is_greeted)
            if self.hello is None:
                continue
            if self.hello.protocol != protocol:
                # It has named the newest protocol that it speaks.
                protocol = self.hello.protocol
                continue
            # What comes from now on is of this session.
            self.states = []
            self.listen(HELLO_EVERY, lambda: bool(self.states))
            if self.states:
                self.forget()
                return self.hello
        raise PalpateError(
            "{port}: no device that speaks the link answers; check port, cable and power, see "
            "'palpate devices'",
            port=str(self.port.port),
        )

    def forget(self) -> None:
        """Begin to remember anew, from the newest STATE on."""
        self.states, self.faults, self.others = self.states[-1:], [], []

    def say(self, data: bytes) -> None:
        """Send bytes."""
        now = self.now()
        self.longest_pause = max(self.longest_pause, now - self._said_at)
        self._said_at = now
        self.port.write(data)

    def listen(self, seconds: float, until: Callable[[], bool] = lambda: False) -> None:
        """Hear for so long, or until something is so."""
        deadline = self.now() + seconds
        while True:
            self._take()
            if until() or self.now() >= deadline:
                return
            self.wait(LOOK_EVERY)

    def force(self, ahead: int = 1) -> bytes:
        """The frame of the next FORCE, `ahead` of the last one, as fresh as what was heard."""
        self._take()
        self.sequence = (self.sequence + ahead) % link.SEQUENCES
        return link.encode(self.same_force())

    def same_force(self, *, answers_us_ago: int = 0) -> link.Force:
        """A FORCE of the last number, which answers the newest STATE or one so much older."""
        where = [self.dice.gauss(0.0, 1.0) for _ in range(3)]
        strength = self.dice.uniform(0.0, 0.9) * self.largest_mn / max(1e-9, math.hypot(*where))
        x, y, z = (int(part * strength) for part in where)
        answer = None
        if self.is_second:
            answer = link.Answer((self.device_time - answers_us_ago) % TIMES)
        return link.Force(self.sequence, (x, y, z), link.ForceFlag.ENABLE, answer)

    def drive(self, seconds: float) -> int:
        """Say sound forces for so long; returns the device's time when the last one was said."""
        deadline = self.now() + seconds
        said = self.device_time
        while self.now() < deadline:
            frame = self.force()
            said = self.device_time
            self.say(frame)
            self.listen(FORCE_EVERY)
        return said

    def is_greeted(self) -> bool:
        """Whether a HELLO was heard since that was forgotten."""
        return self.hello is not None

    @property
    def is_second(self) -> bool:
        """Whether protocol 2 is spoken."""
        return self.hello is not None and self.hello.protocol > link.FIRST_PROTOCOL

    @property
    def device_time(self) -> int:
        """Of the newest STATE, us."""
        return self.states[-1].device_time_us

    def _take(self) -> None:
        data = self.port.read(self.port.in_waiting or 0)
        now = self.now()
        for message in self._decoder.feed(data):
            match message:
                case link.State():
                    self.longest_pause = max(self.longest_pause, now - self._heard_at)
                    self._heard_at = now
                    self.states.append(message)
                case link.Fault():
                    self.faults.append((message, len(self.states)))
                case link.DeviceHello():
                    self.hello = message
                case link.Orientation():
                    pass
                case _:
                    self.others.append(message)
