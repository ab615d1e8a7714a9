"""Kinematics and statics of the five-bar arm of a Haply 2DIY.

Points of the plane are complex numbers, m, in the arm's own axes: motor 1 at 0, motor 2 at
`spacing` on the real axis, angles from the real towards the imaginary axis. Independent of
the servo's geometry, which is tested against it: the handle by intersecting circles, forces by
statics.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

Pair = tuple[float, float]
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class FiveBar:
    """Five-bar linkage. Lengths in m: motor to elbow, elbow to handle, motor to motor."""

    proximal: float
    distal: float
    spacing: float

    def handle(self, angles: Pair) -> complex | None:
        """Place of the handle for motor angles (rad), or None where the forearms cannot meet."""
        left, right = self._elbows(angles)
        gap, bearing = cmath.polar(right - left)
        if not 0.0 < gap <= 2.0 * self.distal:
            return None
        return left + cmath.rect(self.distal, bearing + math.acos(0.5 * gap / self.distal))

    def angles(self, handle: complex) -> Pair | None:
        """Motor angles (rad) for a place of the handle with the elbows outwards, or None beyond
        the arms' reach. The first is in [0, 2 pi), the second in (-pi, pi].
        """
        left = self._shoulder(handle, +1.0)
        right = self._shoulder(handle - self.spacing, -1.0)
        if left is None or right is None:
            return None
        return left % math.tau, math.remainder(right, math.tau)

    def handle_force(self, angles: Pair, torques: Pair) -> complex:
        """Force on the handle (N) of motors with these torques (N m).

        Forearms carry force only along themselves: motor i balances one of size tau / (l sin beta),
        beta the angle between its links, at least 1 mrad: no torque holds a stretched arm.
        """
        handle = self.handle(angles)
        if handle is None:
            return 0j
        force = 0j
        for elbow, angle, torque in zip(self._elbows(angles), angles, torques, strict=True):
            forearm = (handle - elbow) / self.distal
            sine = (forearm * cmath.exp(-1j * angle)).imag
            sine = math.copysign(max(abs(sine), 1e-3), sine)
            force += forearm * torque / (self.proximal * sine)
        return force

    def _elbows(self, angles: Pair) -> tuple[complex, complex]:
        return (
            cmath.rect(self.proximal, angles[0]),
            self.spacing + cmath.rect(self.proximal, angles[1]),
        )

    def _shoulder(self, way: complex, side: float) -> float | None:
        reach = abs(way)
        if not abs(self.proximal - self.distal) < reach < self.proximal + self.distal:
            return None
        cosine = (self.proximal**2 + reach**2 - self.distal**2) / (2.0 * self.proximal * reach)
        return cmath.phase(way) + side * math.acos(cosine)
