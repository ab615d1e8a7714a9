"""The servo's own ticks against the simulated program of a hAPI board, in virtual time."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ....core.servo.haply_models import DEFAULT_MODEL, haply_model
from ....core.servo.stepped import SteppedServo
from ...board.haply_firmware import PORTS, TORQUES, HaplyFirmware
from ..target import Target
from .shot import Said
from .virtual_press import Place, VirtualPress

UPRIGHT_PLANE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""The device's plane stands on its edge: away from the user is up."""
MIDDLE_BELOW_HOVER = 0.01
SET_UP_TICKS = 300
LEAST_TORQUE = 1e-6
"""N m: less moves nothing."""


@dataclass(frozen=True)
class _Plane:
    rotation: NDArray[np.float64]
    translation: NDArray[np.float64]
    scale: float = 1.0


class HaplyPress(VirtualPress):
    """A servo and a Haply 2DIY, its handle over the body, through a line in memory.

    Raises PalpateError where the servo cannot be stepped.
    """

    def __init__(self, target: Target) -> None:
        self._model = haply_model(DEFAULT_MODEL)
        middle = target.hover + MIDDLE_BELOW_HOVER * target.inward
        self._plane = _Plane(UPRIGHT_PLANE, middle)
        self._degrees = self._model.rest_degrees
        super().__init__(target)
        self.board = HaplyFirmware(self._counts)
        self.position = self._to_body(self._model.rest)
        for _ in range(SET_UP_TICKS):
            if self.tick().state in ("ramping", "free"):
                break
        self.glide(target.above)

    def _servo(self, haply: str | None = DEFAULT_MODEL) -> SteppedServo:
        self.settings = replace(self.settings, frames=(self._plane,))
        return super()._servo(haply)

    def _to_body(self, place: tuple[float, float, float]) -> Place:
        return np.asarray(self._plane.rotation @ np.array(place) + self._plane.translation)

    def _speak(self, now: float) -> bytes:
        x, y, z = self._plane.rotation.T @ (self.position - self._plane.translation)
        self._degrees = self._model.angles((x, y, z)) or self._degrees
        return self.board.run(now)

    def _hear(self, sent: bytes) -> None:
        self.board.receive(sent)

    def _motors(self) -> Place:
        first, second = (
            self.board.torque(port) * (1.0 if sense == 0 else -1.0)
            for port, sense in zip(self._model.ports, self._model.motor_senses, strict=True)
        )
        radians = (math.radians(self._degrees[0]), math.radians(self._degrees[1]))
        force = self._model.arm.handle_force(radians, (first, second))
        return np.asarray(self._plane.rotation @ np.array(self._model.device_force(force)))

    def _heard(self, sent: bytes) -> Said:
        requests = [sent[at : at + 10] for at in range(0, len(sent), 10)]
        torques = [one for one in requests if len(one) == 10 and one[0] == TORQUES]
        pushes = sum(
            max(map(abs, struct.unpack_from("<2f", one, 2))) > LEAST_TORQUE for one in torques
        )
        return Said(driving=pushes, released=len(torques) - pushes)

    def _counts(self) -> list[int]:
        counts = [0] * PORTS
        for port, sense, degrees, resolution in zip(
            self._model.ports,
            self._model.encoder_senses,
            self._degrees,
            self._model.resolutions,
            strict=True,
        ):
            count = math.floor(degrees * resolution / 2.0 / 360.0)
            counts[port] = count if sense == 0 else -count
        return counts
