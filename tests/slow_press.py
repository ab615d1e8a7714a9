"""A press over a line of any speed, in virtual time: how old each force is when the device has it.

Both directions carry a byte in ten bits, one after the other; what waits for its turn waits as in a
driver's buffer that nobody can look into.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from palpate_servo.harness import SteppedServo

from palpate.core.servo import link
from palpate.core.servo.settings import Settings
from palpate.simulated.attack.target import ABOVE, DEEP, YOUNG_MODULUS, cube
from palpate.simulated.board.simulated_firmware import Firmware

TICK = 1e-3
BITS = 10
STEP = 1e-4
"""Of the device and the line, s."""
STILL_SECONDS = 0.3
"""Until the hand sets out."""
GLIDE_SECONDS = 0.3
ROOM_BYTES = 32
"""The device leaves out a STATE that would wait behind more."""


class Wire:
    """One direction. Frames leave one after the other; each arrives whole, with its last byte."""

    def __init__(self, baud: float) -> None:
        self._seconds_per_byte = BITS / baud
        self._free_at = 0.0
        self._frames: deque[tuple[float, float, bytes]] = deque()

    def waiting(self, now: float) -> float:
        """Bytes that have not been carried yet."""
        return max(0.0, self._free_at - now) / self._seconds_per_byte

    def seconds(self, frame: bytes) -> float:
        """Time that a frame takes."""
        return len(frame) * self._seconds_per_byte

    def put(self, frames: bytes, now: float) -> None:
        """Give it whole frames."""
        for frame in (part + b"\0" for part in frames.split(b"\0") if part):
            self._free_at = max(self._free_at, now) + self.seconds(frame)
            self._frames.append((self._free_at, now, frame))

    def take(self, now: float) -> Iterator[tuple[float, bytes]]:
        """Frames that have arrived, with the time at which each was put."""
        while self._frames and self._frames[0][0] <= now + 1e-9:
            _, put_at, frame = self._frames.popleft()
            yield put_at, frame


@dataclass
class Aged:
    """What arrived at a device, ages in s."""

    oldest_push: float = 0.0
    """Of a FORCE with *enable*, beyond the time that the line takes for it."""
    oldest: float = 0.0
    """The same of any FORCE."""
    pushes: int = 0
    largest: float = 0.0
    """N, as the motors made it."""
    largest_in_silence: float = 0.0
    """N, made while the device took its time to read, and just after."""
    seen: set[str] = field(default_factory=set)
    """Names of faults since the hand set out."""
    deaf_after: float | None = None
    """From the moment when the device stopped reading until the servo said so, s."""
    queued: int = 0
    """FORCE that had come meanwhile."""
    queued_pushes: int = 0
    """Those of them with *enable*."""
    last_pushes: bool = False
    """The last of them has it."""
    newest_push_in_silence: float = 0.0
    """When the last of them was put on the line, s."""
    largest_at_the_end: float = 0.0
    """N, in the last 0.1 s."""


def press(
    baud: float,
    rate_hz: int,
    protocol: int = link.PROTOCOL,
    *,
    seconds: float = 3.0,
    reads_not: tuple[float, float] = (np.inf, np.inf),
) -> Aged:
    """Press a cube for some seconds; the device does not read in an interval of time."""
    servo = SteppedServo(cube(), Settings(YOUNG_MODULUS), ramp_seconds=0.05)
    device = Firmware(link.DeviceHello("Slow", 3, 3.0, (0.1, 0.1, 0.1), rate_hz, protocol))
    there, back, found = Wire(baud), Wire(baud), Aged()
    stored: list[bytes] = []
    next_state, next_tick = 0.0, TICK
    for number in range(round(seconds / STEP)):
        now = number * STEP
        deaf = reads_not[0] <= now < reads_not[1]
        for put_at, frame in there.take(now):
            _weigh(found, frame, now - put_at - there.seconds(frame))
            stored.append(frame)
            if deaf and _pushes(frame):
                found.newest_push_in_silence = put_at
        if deaf:
            _count(found, stored)
        else:
            for frame in stored:
                back.put(device.receive(frame, now), now)
                silent = reads_not[0] <= now < reads_not[1] + 0.01
                _feel(found, device, silent, at_the_end=now > seconds - 0.1)
            stored.clear()
        back.put(device.watch(now, STEP), now)
        if now >= next_state:
            next_state += 1.0 / rate_hz
            if back.waiting(now) <= ROOM_BYTES:
                back.put(device.state(now, _position(now), 0), now)
        if now >= next_tick:
            next_tick += TICK
            heard = b"".join(frame for _, frame in back.take(now))
            there.put(servo.tick(heard), now)
            fault = servo.snapshot().fault
            _note(found, fault, now, now - reads_not[0] if deaf else None)
    return found


def _note(found: Aged, fault: str, now: float, deaf_for: float | None) -> None:
    if fault and now > STILL_SECONDS:
        found.seen.add(fault)
    if fault == "deaf" and found.deaf_after is None:
        found.deaf_after = deaf_for


def _feel(found: Aged, device: Firmware, silent: bool, *, at_the_end: bool) -> None:
    felt = float(np.linalg.norm(device.force))
    found.largest = max(found.largest, felt)
    if at_the_end:
        found.largest_at_the_end = max(found.largest_at_the_end, felt)
    if silent:
        found.largest_in_silence = max(found.largest_in_silence, felt)


def _position(now: float) -> tuple[int, int, int]:
    """Above the cube, then in it, um."""
    part = min(1.0, max(0.0, now - 0.3) / GLIDE_SECONDS)
    x, y, z = (1e6 * (np.array(ABOVE) + part * (np.array(DEEP) - np.array(ABOVE)))).round()
    return int(x), int(y), int(z)


def _forces(frames: list[bytes]) -> list[link.Force]:
    messages = link.Decoder().feed(b"".join(frames))
    return [message for message in messages if isinstance(message, link.Force)]


def _pushes(frame: bytes) -> bool:
    return any(force.flags & link.ForceFlag.ENABLE for force in _forces([frame]))


def _count(found: Aged, frames: list[bytes]) -> None:
    forces = _forces(frames)
    pushes = [bool(force.flags & link.ForceFlag.ENABLE) for force in forces]
    found.queued, found.queued_pushes = len(forces), sum(pushes)
    found.last_pushes = bool(pushes) and pushes[-1]


def _weigh(found: Aged, frame: bytes, waited: float) -> None:
    for force in _forces([frame]):
        found.oldest = max(found.oldest, waited)
        if force.flags & link.ForceFlag.ENABLE:
            found.pushes += 1
            found.oldest_push = max(found.oldest_push, waited)
