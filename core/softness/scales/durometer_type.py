"""Durometers by ASTM D2240: an indenter on a spring, in the hole of a flat foot.

Figures are the nominal ones of ASTM D2240 for types A and 00, in SI units. A reading of 100 means
that the indenter is pushed back flush with the foot, 0 that it stands out all the way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

MILLIMETRE = 1e-3


@dataclass(frozen=True)
class DurometerType:
    """Type of durometer. Lengths in metres, forces in newton.

    Attributes
    ----------
    name : of the scale: "A" or "00".
    travel : length of the indenter out of the foot at a reading of 0.
    force_at_zero, force_per_point : the spring's law, F = force_at_zero + force_per_point * S.
    shaft : largest radius of the indenter; above its tip it is a cylinder.
    tip : radius of the flat end of a truncated cone, or 0 for a ball of radius ``shaft``.
    half_angle : of the cone, radians; 0 for a ball.
    foot, hole : outer radius of the foot and radius of its hole.
    load : on the foot in the standard's stand (a mass times 9.81 m/s2).
    """

    name: str
    travel: float
    force_at_zero: float
    force_per_point: float
    shaft: float
    tip: float
    half_angle: float
    foot: float
    hole: float
    load: float

    def depth(self, reading: float) -> float:
        """Length of the indenter out of the foot at a reading, metres."""
        return self.travel * (1.0 - reading / 100.0)

    def force(self, reading: float) -> float:
        """Force of the spring at a reading, newton."""
        return self.force_at_zero + self.force_per_point * reading

    def profile(self, radius: ArrayLike) -> NDArray[np.float64]:
        """Height of the indenter's surface over its lowest point, metres; infinite off the shaft.

        ``radius`` are distances from the axis, metres.
        """
        r = np.asarray(radius, dtype=np.float64)
        if self.tip > 0.0:
            height = np.maximum(r - self.tip, 0.0) / np.tan(self.half_angle)
        else:
            height = self.shaft - np.sqrt(np.maximum(self.shaft**2 - r**2, 0.0))
        return np.where(r <= self.shaft, height, np.inf)


TYPE_A = DurometerType(
    name="A",
    travel=2.54 * MILLIMETRE,
    force_at_zero=0.55,
    force_per_point=0.075,
    shaft=0.635 * MILLIMETRE,
    tip=0.395 * MILLIMETRE,
    half_angle=float(np.radians(17.5)),
    foot=9.0 * MILLIMETRE,
    hole=1.5 * MILLIMETRE,
    load=9.81,
)
TYPE_00 = DurometerType(
    name="00",
    travel=2.54 * MILLIMETRE,
    force_at_zero=0.203,
    force_per_point=0.00908,
    shaft=1.19 * MILLIMETRE,
    tip=0.0,
    half_angle=0.0,
    foot=9.0 * MILLIMETRE,
    hole=1.5 * MILLIMETRE,
    load=0.4 * 9.81,
)
TYPES = {kind.name: kind for kind in (TYPE_00, TYPE_A)}
