"""The servo's own ticks against the simulated device's own program, in virtual time.

Both ends speak the link byte for byte, each with its own codec; between them stands whoever wants
to spoil it. Nothing waits, so that thousands of faults take seconds, and every run gives the same.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from palpate_servo import Body
from palpate_servo.harness import SteppedServo

from palpate.core.servo import link
from palpate.core.servo.settings import Settings
from palpate.simulated.board.simulated_firmware import Firmware
from palpate.simulated.hand.quaternion import Quaternion

from .servo_host import ABOVE, DEEP, YOUNG_MODULUS

PERIOD = 1e-3
RAMP_SECONDS = 0.05
MAX_FORCE = 3.0
MAX_SLEW = 500.0
GLIDE_TICKS = 40
PATIENCE_TICKS = 1000
STORED_BYTES = 20_000


@dataclass(frozen=True)
class Shot:
    """One tick: what the servo says, wants and sends (N), and what the device's motors make (N)."""

    state: str
    fault: str
    reason: str
    limited: str
    wanted: float
    output: float
    change: float
    """Between this output and the one before, N."""
    felt: float

    @property
    def name(self) -> str:
        """The fault, or the state with its reason."""
        return self.fault or (f"{self.state}: {self.reason}" if self.reason else self.state)

    @property
    def whole(self) -> bool:
        """The body is felt as it is."""
        return self.state == "touching" and not self.limited


class VirtualPress:
    """A servo and a device that speak through a line in memory."""

    def __init__(self, body: Body, *, largest_force: float = MAX_FORCE) -> None:
        self.servo = SteppedServo(
            body,
            Settings(YOUNG_MODULUS),
            max_force=MAX_FORCE,
            max_slew=MAX_SLEW,
            ramp_seconds=RAMP_SECONDS,
        )
        extents = (0.1, 0.1, 0.1)
        hello = link.DeviceHello("Scripted", 3, largest_force, extents, 1000, link.PROTOCOL)
        self.device = Firmware(hello)
        self.position = np.array(ABOVE)
        self.buttons = 0
        self.flags = link.StateFlag.READY
        self.turned: Quaternion | None = None
        """How the stylus is turned; None for a device that does not tell."""
        self.now = 0.0
        self._output = np.zeros(3)
        self._answers = b""

    def tick(
        self,
        spoil: Callable[[bytes], bytes] = bytes,
        seconds: float = PERIOD,
        *,
        device_hears: bool = True,
        by: NDArray[np.float64] | None = None,
    ) -> Shot:
        """One tick `seconds` after the last; `spoil` makes of the device's bytes what arrives.

        Meanwhile the device moves `by` so much, m. A line stores `STORED_BYTES` at most.
        """
        steps = max(1, round(seconds / PERIOD))
        from_device = b""
        for _ in range(steps):
            self.now += PERIOD
            if by is not None:
                self.position = self.position + by / steps
            said = self._answers + self.device.watch(self.now, PERIOD) + self._state()
            from_device += said if len(from_device) < STORED_BYTES else b""
            self._answers = b""
        sent = self.servo.tick(spoil(from_device), seconds)
        if device_hears:
            self._answers = self.device.receive(sent, self.now)
        shot = self.servo.snapshot()
        change = float(np.linalg.norm(shot.output_force - self._output))
        self._output = shot.output_force
        return Shot(
            state=shot.state,
            fault=shot.fault,
            reason=shot.reason,
            limited=shot.limited,
            wanted=float(np.linalg.norm(shot.contact_force)),
            output=float(np.linalg.norm(shot.output_force)),
            change=change,
            felt=float(np.linalg.norm(self.device.force)),
        )

    def glide(self, goal: tuple[float, float, float]) -> list[Shot]:
        """Bring the device to a place."""
        start = np.array(self.position)
        shots = []
        for part in np.linspace(0.0, 1.0, GLIDE_TICKS + 1)[1:]:
            self.position = start + part * (np.array(goal) - start)
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
                shots += self.glide(ABOVE) + self.glide(DEEP)
        raise RuntimeError(f"the body is not felt after {PATIENCE_TICKS} ticks: {shots[-1]}")

    def _state(self) -> bytes:
        x, y, z = (round(metres * 1e6) for metres in self.position)
        turn = b"" if self.turned is None else self.device.orientation(self.turned)
        frame = self.device.state(self.now, (x, y, z), self.buttons)
        if self.flags != link.StateFlag.READY and frame:
            state = state_in(frame)
            told = state.flags & link.StateFlag.TAKEN
            frame = link.encode(replace(state, flags=self.flags | told))
        return turn + frame


def state_in(frames: bytes) -> link.State:
    """The one STATE among these frames; ValueError if it is not one."""
    (state,) = (m for m in link.Decoder().feed(frames) if isinstance(m, link.State))
    return state
