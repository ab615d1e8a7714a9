"""Probe moved in depth by a pointer on a flat screen, without Blender.

A drag along the projected inward normal goes in; where the normal points at the viewer, dragging
downward goes in. The other screen direction moves the probe along the surface. Wheel and pen
pressure add depth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Sine of the angle between normal and view below which dragging downward goes in.
SHORTEST_IMAGE = 0.35
# One notch of the wheel and the largest depth of a pen, as shares of the body's size.
WHEEL_STEP = 0.01
PEN_DEPTH = 0.10


@dataclass(frozen=True, eq=False)
class View:
    """View in which the probe was set down, in body coordinates.

    ``right`` and ``up`` (3,) are unit vectors of the screen; ``metres_per_pixel`` holds at the
    depth of the touched point.
    """

    right: Array
    up: Array
    metres_per_pixel: float


@dataclass(frozen=True, eq=False)
class ProbeDrag:
    """Probe set down at ``point`` on a surface with outward unit normal ``normal``; it goes no
    further in than ``deepest``, metres.
    """

    point: Array
    normal: Array
    view: View
    size: float
    start: tuple[float, float]
    deepest: float = np.inf
    sensitivity: float = 1.0
    cursor: tuple[float, float] | None = None
    notches: int = 0
    pressure: float = 0.0

    def dragged(self, cursor: tuple[float, float], pressure: float = 0.0) -> ProbeDrag:
        """Drag with the pointer at ``cursor`` (pixels) and pen ``pressure`` 0..1."""
        return replace(self, cursor=cursor, pressure=pressure)

    def wheeled(self, notches: int) -> ProbeDrag:
        """Drag with the wheel turned; positive goes in."""
        return replace(self, notches=self.notches + notches)

    @property
    def inward_on_screen(self) -> Array:
        """Unit vector (2,) on the screen along which dragging goes in."""
        image = np.array([-self.normal @ self.view.right, -self.normal @ self.view.up])
        length = float(np.linalg.norm(image))
        return image / length if length > SHORTEST_IMAGE else np.array([0.0, -1.0])

    @property
    def depth(self) -> float:
        """Depth of the probe below the surface along the normal, metres; negative above."""
        along = self._pixels @ self.inward_on_screen
        asked = float(
            along * self.view.metres_per_pixel * self.sensitivity
            + self.notches * WHEEL_STEP * self.size
            + self.pressure * PEN_DEPTH * self.size * self.sensitivity
        )
        return min(asked, self.deepest)

    @property
    def target(self) -> Array:
        """Target of the probe, (3,), body coordinates."""
        inward = self.inward_on_screen
        aside = np.array([-inward[1], inward[0]])
        on_screen = aside[0] * self.view.right + aside[1] * self.view.up
        tangent = on_screen - (on_screen @ self.normal) * self.normal
        length = float(np.linalg.norm(tangent))
        if length > 1e-9:
            tangent /= length
        slide = float(self._pixels @ aside) * self.view.metres_per_pixel * self.sensitivity
        target: Array = self.point - self.depth * self.normal + slide * tangent
        return target

    @property
    def _pixels(self) -> Array:
        cursor = self.cursor or self.start
        return np.subtract(cursor, self.start).astype(np.float64)
