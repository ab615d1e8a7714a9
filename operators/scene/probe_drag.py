"""How a pointer on a flat screen moves a probe in depth. No Blender: vectors in, vectors out.

A drag along the screen image of the inward normal goes in; where that normal points at the viewer
its image is too short to follow, and dragging downward goes in. The other screen direction moves
the probe along the surface. Wheel and pen pressure add depth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Below this sine of the angle between normal and view, dragging downward goes in.
SHORTEST_IMAGE = 0.35
# One notch of the wheel, as a share of the body's size; and the deepest a pen presses.
WHEEL_STEP = 0.01
PEN_DEPTH = 0.10


@dataclass(frozen=True, eq=False)
class View:
    """The view where the probe was set down, in body coordinates.

    ``right`` and ``up`` (3,) are unit vectors of the screen; ``metres_per_pixel`` holds at the
    depth of the touched point.
    """

    right: Array
    up: Array
    metres_per_pixel: float


@dataclass(frozen=True, eq=False)
class ProbeDrag:
    """A probe set down at ``point`` on a surface whose outward unit normal is ``normal``."""

    point: Array
    normal: Array
    view: View
    size: float
    start: tuple[float, float]
    sensitivity: float = 1.0
    cursor: tuple[float, float] | None = None
    notches: int = 0
    pressure: float = 0.0

    def dragged(self, cursor: tuple[float, float], pressure: float = 0.0) -> ProbeDrag:
        """The pointer is at ``cursor`` (pixels), pressing with ``pressure`` 0..1 (pens)."""
        return replace(self, cursor=cursor, pressure=pressure)

    def wheeled(self, notches: int) -> ProbeDrag:
        """The wheel turned; positive goes in."""
        return replace(self, notches=self.notches + notches)

    @property
    def inward_on_screen(self) -> Array:
        """Unit vector (2,) on the screen along which dragging goes in."""
        image = np.array([-self.normal @ self.view.right, -self.normal @ self.view.up])
        length = float(np.linalg.norm(image))
        return image / length if length > SHORTEST_IMAGE else np.array([0.0, -1.0])

    @property
    def depth(self) -> float:
        """How far the probe is below the surface along the normal, metres; negative above."""
        along = self._pixels @ self.inward_on_screen
        return float(
            along * self.view.metres_per_pixel * self.sensitivity
            + self.notches * WHEEL_STEP * self.size
            + self.pressure * PEN_DEPTH * self.size * self.sensitivity
        )

    @property
    def target(self) -> Array:
        """Where the probe should be, (3,), body coordinates."""
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
