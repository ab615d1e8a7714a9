"""Firmware of a simulated device: answers HELLO, streams STATE, applies FORCE, has a watchdog.

No clock and no port of its own: times and bytes are arguments, so that every rule can be tested.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from ...core.servo import link
from ..hand.plant import ZERO, Vector
from ..hand.quaternion import Quaternion

WATCHDOG_SECONDS = 0.020
FRESH_US = 20_000
"""A force that answers an older STATE is refused, us."""

FAULT_LIMP = 1
FAULT_PROTOCOL = 2


@dataclass
class FirmwareCounters:
    """Counters of the device; forces in N."""

    states: int = 0
    hellos: int = 0
    forces: int = 0
    """Valid FORCE messages, enabled or not."""
    lost: int = 0
    """Gaps in the sequence of FORCE."""
    duplicates: int = 0
    out_of_order: int = 0
    refused: int = 0
    """FORCE of protocol 2 that came too late to be obeyed."""
    unexpected: int = 0
    """Valid frames that no host may send, or FORCE before any HELLO."""
    clamped: int = 0
    limp_count: int = 0
    """Number of times the watchdog ran out while a host was driving."""
    limp_after: float = 0.0
    """Latest time from the last valid FORCE to going limp, s."""
    limp_look: float = 0.0
    """Time the board had not looked before that, s: tolerance of `limp_after` above 20 ms."""
    largest_force: float = 0.0


class Firmware:
    """Device's side of the link; `hello` has the newest protocol that it speaks."""

    def __init__(self, hello: link.DeviceHello) -> None:
        self.hello = hello
        self.clock: Callable[[float], float] = float
        """What its own clock shows at a time, s."""
        self._protocol = hello.protocol
        """Protocol of the session."""
        self.counters = FirmwareCounters()
        self.decoder = link.Decoder()
        self.streaming = False
        self._sequence = 0
        self._force = ZERO
        self._braked = False
        self._taken: int | None = None
        """Last FORCE taken in this session."""
        self._looked_at = -math.inf
        self._heard_at: float | None = None
        """When the last valid FORCE came; None while limp."""
        self._heard_sequence = 0

    @property
    def limp(self) -> bool:
        """True while no host drives the device."""
        return self._heard_at is None

    def plug_in(self) -> None:
        """Restart, as a board powered by the plug; counters stay."""
        self.streaming = False
        self._heard_at = None
        errors, self.decoder = self.decoder.errors, link.Decoder()
        self.decoder.errors = errors

    def receive(self, data: bytes, now: float) -> bytes:
        """Process bytes from the host; returns the frames to answer with."""
        return b"".join(self._obey(message, now) for message in self.decoder.feed(data))

    def watch(self, now: float, look_seconds: float = 0.0) -> bytes:
        """Go limp when the host has been silent for too long; returns the FAULT frame.

        A board that looks again only in `look_seconds` goes limp when that would be too late.
        """
        looked_at, self._looked_at = self._looked_at, now
        if self._heard_at is None or now - self._heard_at + look_seconds <= WATCHDOG_SECONDS:
            return b""
        self.counters.limp_after = now - self._heard_at
        self.counters.limp_look = now - max(looked_at, self._heard_at)
        self._heard_at = None
        self.counters.limp_count += 1
        return link.encode(link.Fault(FAULT_LIMP, self.counters.limp_count % (1 << 16)))

    @property
    def force(self) -> Vector:
        """Force of the motors now, N."""
        return ZERO if self.limp else self._force

    @property
    def braked(self) -> bool:
        """True while the host asks for damping."""
        return self._braked and not self.limp

    def state(self, now: float, position_um: tuple[int, int, int], buttons: int) -> bytes:
        """Next STATE, or nothing before the first HELLO."""
        if not self.streaming:
            return b""
        flags, taken = link.StateFlag.READY, None
        if self._protocol > link.FIRST_PROTOCOL:
            taken = self._taken or 0
            flags |= link.StateFlag.TAKEN if self._taken is not None else 0
        message = link.State(
            self._sequence, self._clock_us(now), position_um, buttons, flags, taken
        )
        self._sequence = (self._sequence + 1) % link.SEQUENCES
        self.counters.states += 1
        return link.encode(message)

    def orientation(self, rotation: Quaternion) -> bytes:
        """ORIENTATION of the next STATE, to be sent before it; nothing before the first
        HELLO.
        """
        if not self.streaming:
            return b""
        return link.encode(link.orientation(self._sequence, rotation))

    def _obey(self, message: link.Message, now: float) -> bytes:
        match message:
            case link.HostHello() | link.OtherHello():
                return self._answer(message.protocol)
            case link.Force() if self.streaming and self._is_of_session(message):
                self._take(message, now)
            case _:
                self.counters.unexpected += 1
        return b""

    def _answer(self, protocol: int) -> bytes:
        self.counters.hellos += 1
        # A new session, or none: earlier commands are void.
        self._heard_at = self._taken = None
        self.streaming = link.FIRST_PROTOCOL <= protocol <= self.hello.protocol
        if self.streaming:
            self._protocol = protocol
            return link.encode(replace(self.hello, protocol=protocol))
        # A host of another protocol cannot read STATE, and its messages may mean anything.
        return link.encode(self.hello) + link.encode(link.Fault(FAULT_PROTOCOL, protocol))

    def _clock_us(self, now: float) -> int:
        return round(self.clock(now) * 1e6) % (1 << 32)

    def _is_of_session(self, message: link.Force) -> bool:
        return (message.answer is not None) == (self._protocol > link.FIRST_PROTOCOL)

    def _is_old(self, message: link.Force, now: float) -> bool:
        """Whether it drives, and answers a STATE that was made too long ago."""
        if message.answer is None or not message.flags:
            return False
        return (self._clock_us(now) - message.answer.state_time_us) % (1 << 32) > FRESH_US

    def _take(self, message: link.Force, now: float) -> None:
        counters = self.counters
        if self._is_old(message, now):
            counters.refused += 1
            return
        if not self.limp:
            ahead = (message.sequence - self._heard_sequence) % link.SEQUENCES
            if ahead == 0:
                counters.duplicates += 1
                return
            if ahead >= link.SEQUENCES // 2:
                counters.out_of_order += 1
                return
            counters.lost += ahead - 1
        counters.forces += 1
        self._heard_at, self._heard_sequence = now, message.sequence
        self._taken = message.sequence
        asked = message.answer is None or message.answer.damping > 0
        self._braked = bool(message.flags & link.ForceFlag.DAMP) and asked
        self._force = ZERO
        if message.flags & link.ForceFlag.ENABLE:
            self._force = self._within_limit(message.force_mn)
            counters.largest_force = max(counters.largest_force, math.hypot(*self._force))

    def _within_limit(self, force_mn: tuple[int, int, int]) -> Vector:
        x, y, z = (component * 1e-3 for component in force_mn)
        size, limit = math.hypot(x, y, z), self.hello.largest_force
        # Rounding to mN may exceed the limit.
        if size <= limit + 1e-3:
            return (x, y, z)
        self.counters.clamped += 1
        scale = limit / size
        return (x * scale, y * scale, z * scale)
