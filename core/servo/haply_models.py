"""Models of the 2DIY for simulation: lengths, ports and rest poses."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from ..errors import PalpateError
from .haply_arm import FiveBar, Pair, Vector


@dataclass(frozen=True)
class HaplyModel:
    """Device as built.

    Ports count from 0; senses are those that make angles and torques correct; resolutions are the
    counts per turn that hosts set.
    """

    arm: FiveBar
    ports: tuple[int, int]
    """Port of motor 1 (at the arm's origin) and of motor 2."""
    motor_senses: tuple[int, int]
    encoder_senses: tuple[int, int]
    rest_degrees: Pair
    resolutions: Pair
    centre: complex
    """Centre of the workspace in the arm's axes, m."""

    def device_position(self, handle: complex) -> Vector:
        """Position in the servo's axes (right, away, up) from the arm's (left, to the user)."""
        offset = self.centre - handle
        return (offset.real, offset.imag, 0.0)

    def handle(self, position: Vector) -> complex:
        """Place of the handle in the arm's axes; inverse of :meth:`device_position`."""
        return self.centre - complex(position[0], position[1])

    def device_force(self, force: complex) -> Vector:
        """Force in the servo's axes, from the arm's."""
        return (-force.real, -force.imag, 0.0)

    @property
    def rest(self) -> Vector:
        """Rest pose, m."""
        handle = self.arm.handle((self._radians[0], self._radians[1]))
        if handle is None:
            raise PalpateError("simulated 2DIY: this model has no rest pose; mend its figures")
        return self.device_position(handle)

    @property
    def _radians(self) -> Pair:
        return (math.radians(self.rest_degrees[0]), math.radians(self.rest_degrees[1]))

    def angles(self, position: Vector) -> Pair | None:
        """Motor angles (degrees, continuous from the rest pose) at a position."""
        found = self.arm.angles(self.handle(position))
        if found is None:
            return None
        # Within half a turn of the rest pose.
        first, second = (
            rest + math.degrees(cmath.phase(cmath.exp(1j * (angle - math.radians(rest)))))
            for angle, rest in zip(found, self.rest_degrees, strict=True)
        )
        return first, second


_V3 = FiveBar(0.07, 0.09, 0.038)

HAPLY_MODELS = {
    "2diy-3.1": HaplyModel(
        _V3, (1, 0), (1, 1), (1, 1), (168.0, 12.0), (4880.0, 4880.0), 0.019 + 0.095j
    ),
    "2diy-3.0": HaplyModel(
        _V3, (1, 0), (1, 1), (1, 1), (97.23, 82.77), (5299.7056, 5219.328), 0.019 + 0.095j
    ),
    "2diy-2": HaplyModel(
        FiveBar(0.07, 0.09, 0.0),
        (1, 0),
        (1, 0),
        (1, 0),
        (241.0, -61.0),
        (10752.0, 10752.0),
        0.085j,
    ),
    "kit": HaplyModel(
        FiveBar(0.05, 0.07, 0.02),
        (0, 1),
        (0, 0),
        (0, 0),
        (180.0, 0.0),
        (13824.0, 13824.0),
        0.01 + 0.07j,
    ),
}
"""Models by the servo's names."""
DEFAULT_MODEL = "2diy-3.1"

HAPI_USB_IDS = frozenset(
    # USB ids of the native ports of the Arduino Due, Zero, M0 and M0 Pro, which hAPI boards show.
    f"{vendor}:{product}"
    for vendor in ("2341", "2a03")
    for product in ("003e", "804d", "804e", "804f")
)
"""VID:PID of possible hAPI boards."""


def haply_model(name: str) -> HaplyModel:
    """Model by name; raises PalpateError for an unknown one."""
    try:
        return HAPLY_MODELS[name]
    except KeyError:
        known = ", ".join(HAPLY_MODELS)
        raise PalpateError(f"simulated 2DIY: no model {name!r}; take one of {known}") from None
