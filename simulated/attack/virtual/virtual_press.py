"""The servo's own ticks against the simulated device's own program, in virtual time.

Both ends speak the link byte for byte, each with its own codec; between them stands whoever wants
to spoil it. Nothing waits, so that thousands of faults take seconds, and every run gives the same.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ....core.servo import link
from ....core.servo.settings import Settings
from ....core.servo.stepped import SteppedServo, stepped_servo
from ...board.simulated_firmware import Firmware
from ...hand.quaternion import Quaternion
from ..target import Target
from .shot import Said, Shot

PERIOD = 1e-3
RAMP_SECONDS = 0.05
MAX_FORCE = 3.0
MAX_SLEW = 500.0
GLIDE_TICKS = 40
PATIENCE_TICKS = 1000
STORED_BYTES = 20_000
SAME_TIME = 1e-9
"""Times closer than this are the same, s."""

Place = NDArray[np.float64]


class NotFeltError(RuntimeError):
    """The servo does not come to where it can be attacked (again)."""


class VirtualPress:
    """A servo and a device that speaks the link, through a line in memory.

    Raises PalpateError where the servo cannot be stepped.
    """

    def __init__(
        self,
        target: Target,
        *,
        rate_hz: int = 1000,
        protocol: int = link.PROTOCOL,
        largest_force: float = MAX_FORCE,
    ) -> None:
        self.target = target
        self.settings = Settings(target.young_modulus)
        self.servo = self._servo()
        extents = (0.1, 0.1, 0.1)
        hello = link.DeviceHello("Scripted", 3, largest_force, extents, rate_hz, protocol)
        self.device = Firmware(hello)
        self.position: Place = target.above.copy()
        self.path: Callable[[float], Place] | None = None
        """Where the device is at a time, instead of `position`."""
        self.buttons = 0
        self.flags = link.StateFlag.READY
        self.turned: Quaternion | None = None
        """How the stylus is turned; None for a device that does not tell."""
        self.altered: Callable[[link.State], link.State] | None = None
        """What becomes of each STATE before it is sent."""
        self.rate_hz = rate_hz
        self.arrival: Callable[[float], float] = float
        """When the line hands over what is said at a time, s; never before what was said before."""
        self.deaf = False
        """Whether the device reads nothing."""
        self.baud: int | None = None
        """Speed of the line to the device, bits a second; None for one without bounds."""
        self.now = 0.0
        self._room = 0.0
        self._made_until = 0.0
        self._in_flight: deque[tuple[float, bytes]] = deque()
        self._output = np.zeros(3)
        self._felt = np.zeros(3)
        self._told_at = 0.0
        self._answers = b""
        self._listener = link.Decoder()

    def _servo(self, haply: str | None = None) -> SteppedServo:
        return stepped_servo(
            self.target.body,
            self.settings,
            max_force=MAX_FORCE,
            max_slew=MAX_SLEW,
            ramp_seconds=RAMP_SECONDS,
            haply=haply,
        )

    @property
    def clock(self) -> Callable[[float], float]:
        """What the device's clock shows at a time, s."""
        return self.device.clock

    @clock.setter
    def clock(self, clock: Callable[[float], float]) -> None:
        self.device.clock = clock

    def tick(
        self,
        spoil: Callable[[bytes], bytes] = bytes,
        seconds: float = PERIOD,
        *,
        device_hears: bool = True,
        by: Place | None = None,
    ) -> Shot:
        """One tick `seconds` after the last; `spoil` makes of the device's bytes what arrives.

        Meanwhile the device moves `by` so much, m. A line stores `STORED_BYTES` at most.
        """
        end = self.now + seconds
        steps = max(1, round(seconds * self.rate_hz))
        stored = 0
        while self._made_until + 1.0 / self.rate_hz <= end + SAME_TIME:
            self._made_until += 1.0 / self.rate_hz
            if by is not None:
                self.position = self.position + by / steps
            if self.path is not None:
                self.position = self.path(self._made_until)
            said = self._speak(self._made_until)
            stored += len(said)
            if stored < STORED_BYTES:
                self._put(said)
        self.now = end
        sent = self.servo.tick(spoil(self._arrived()), seconds, self._taken(seconds))
        if device_hears:
            self._hear(sent)
        return self._shot(sent)

    def glide(self, goal: Place) -> list[Shot]:
        """Bring the device to a place."""
        start = np.array(self.position)
        shots = []
        for part in np.linspace(0.0, 1.0, GLIDE_TICKS + 1)[1:]:
            self.position = start + part * (goal - start)
            shots.append(self.tick())
        return shots

    def press(self) -> list[Shot]:
        """From wherever it is until the body is felt as it is; out and in again if it must be."""
        shots = []
        for _ in range(PATIENCE_TICKS):
            shots.append(self.tick())
            last = shots[-1]
            if last.whole:
                return shots
            if last.state == "free":
                shots += self.glide(self.target.above) + self.glide(self.target.deep)
        raise NotFeltError(f"the body is not felt after {PATIENCE_TICKS} ticks: {shots[-1]}")

    def hover(self) -> list[Shot]:
        """From wherever it is to close above the body, where nothing is felt."""
        shots = self.glide(self.target.above) + self.glide(self.target.hover)
        for _ in range(PATIENCE_TICKS):
            shots.append(self.tick())
            if shots[-1].state == "free" and not shots[-1].reason:
                return shots
        raise NotFeltError(f"it is not free after {PATIENCE_TICKS} ticks: {shots[-1]}")

    def count(self, name: str) -> int:
        """A counter of the line; `damaged` is the sum of all that damage may be taken for."""
        told = self.servo.counters()["link"]
        counts = {str(key): value for key, value in told.items() if isinstance(value, int)}
        if name == "damaged":
            return sum(counts[key] for key in ("crc_errors", "cobs_errors", "oversize", "unknown"))
        return counts.get(name, 0)

    @property
    def faults(self) -> int:
        """How many faults were counted."""
        return sum(self.servo.counters()["faults"].values())

    def _taken(self, seconds: float) -> int | None:
        """How many bytes the device takes in a tick."""
        if self.deaf:
            return 0
        if self.baud is None:
            return None
        self._room = min(self._room, 1.0) + self.baud / 10.0 * seconds
        whole = int(self._room)
        self._room -= whole
        return whole

    def _put(self, said: bytes) -> None:
        arrival = max(self._made_until, self.arrival(self._made_until))
        if self._in_flight:
            arrival = max(arrival, self._in_flight[-1][0])
        self._in_flight.append((arrival, said))

    def _arrived(self) -> bytes:
        arrived = b""
        while self._in_flight and self._in_flight[0][0] <= self.now + SAME_TIME:
            arrived += self._in_flight.popleft()[1]
        return arrived

    def _speak(self, now: float) -> bytes:
        """Everything the device says in one of its periods."""
        said = self._answers + self.device.watch(now, 1.0 / self.rate_hz) + self._state(now)
        self._answers = b""
        return said

    def _hear(self, sent: bytes) -> None:
        self._answers += self.device.receive(sent, self.now)

    def _motors(self) -> Place:
        return np.array(self.device.force)

    def _heard(self, sent: bytes) -> Said:
        forces = [m for m in self._listener.feed(sent) if isinstance(m, link.Force)]
        on = [bool(force.flags & link.ForceFlag.ENABLE) for force in forces]
        pushes = [any(force.force_mn) for force in forces]
        return Said(
            driving=sum(a and b for a, b in zip(on, pushes, strict=True)),
            released=sum(not a and not b for a, b in zip(on, pushes, strict=True)),
            hollow=sum(not a and b for a, b in zip(on, pushes, strict=True)),
        )

    def _shot(self, sent: bytes) -> Shot:
        shot, said, felt = self.servo.snapshot(), self._heard(sent), self._motors()
        change = float(np.linalg.norm(shot.output_force - self._output))
        grows = np.linalg.norm(felt) > np.linalg.norm(self._felt)
        slew = float(np.linalg.norm(felt - self._felt) / (self.now - self._told_at) * grows)
        self._output, self._felt = shot.output_force, felt
        if said != Said():
            self._told_at = self.now
        return Shot(
            state=shot.state,
            fault=shot.fault,
            reason=shot.reason,
            limited=shot.limited,
            wanted=float(np.linalg.norm(shot.contact_force)),
            output=float(np.linalg.norm(shot.output_force)),
            change=change,
            felt=float(np.linalg.norm(felt)),
            felt_slew=slew,
            said=said,
        )

    def _state(self, now: float) -> bytes:
        x, y, z = (round(metres * 1e6) for metres in self.position)
        turn = b"" if self.turned is None else self.device.orientation(self.turned)
        frame = self.device.state(now, (x, y, z), self.buttons)
        if frame and self.flags != link.StateFlag.READY:
            frame = link.encode(flagged(state_in(frame), self.flags))
        if frame and self.altered is not None:
            frame = link.encode(self.altered(state_in(frame)))
        return turn + frame


def flagged(state: link.State, flags: link.StateFlag) -> link.State:
    """The same with other flags, but for the one that is about FORCE."""
    return replace(state, flags=flags | state.flags & link.StateFlag.TAKEN)


def state_in(frames: bytes) -> link.State:
    """The one STATE among these frames; ValueError if it is not one."""
    (state,) = (m for m in link.Decoder().feed(frames) if isinstance(m, link.State))
    return state
