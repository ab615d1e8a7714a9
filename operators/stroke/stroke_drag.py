"""Drag of a stroke on a flat screen: how far from its start, or what was typed, without Blender.

Every way away from the start goes on, and back to it goes back: there is no wrong direction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..scene.probe_drag import PEN_DEPTH, View
from .answer.motion import Asked, Motion

Array = NDArray[np.float64]

# A pinch is drawn in by this share of the drag over the radius, up to a largest one.
PINCH_SHARE, MOST_PINCHED = 0.5, 0.95


@dataclass(frozen=True, eq=False)
class StrokeDrag:
    """Drag from a place that was touched.

    Attributes
    ----------
    motion : of the stroke.
    sign : -1 for the other direction: pull, turn back, spread.
    view : axes of the screen in those of the body as seen, and its scale.
    radius : of the patch, metres.
    size : of the body, metres.
    strength : how much a drag moves; 1 follows the pointer.
    start, cursor : pixels.
    pressure : of a pen, 0 to 1.
    aside : pixels by which a push has gone along the surface.
    typed : amount by the keyboard, in metres, radians or a share; None without.
    """

    motion: Motion
    sign: float
    view: View
    radius: float
    size: float
    strength: float
    start: tuple[float, float]
    cursor: tuple[float, float]
    pressure: float = 0.0
    aside: tuple[float, float] = (0.0, 0.0)
    typed: float | None = None

    def dragged(
        self, cursor: tuple[float, float], pressure: float = 0.0, *, sliding: bool = False
    ) -> StrokeDrag:
        """The drag with its pointer at ``cursor`` and a pen's ``pressure``; ``sliding`` takes a
        push along the surface and leaves its depth as it is, as a pen does, whose pressure is the
        depth.
        """
        moved = replace(self, cursor=cursor, pressure=pressure)
        if self.motion is not Motion.PUSH or not (sliding or pressure > 0.0):
            return moved
        step = np.subtract(cursor, self.cursor)
        x, y = np.add(self.start, step)
        aside_x, aside_y = np.add(self.aside, step)
        return replace(moved, start=(x, y), aside=(aside_x, aside_y))

    @property
    def distance(self) -> float:
        """From the start, metres at the touched place, times the strength."""
        return float(np.linalg.norm(self._way))

    def asked(self, turn: Array) -> Asked:
        """What it asks of the body; ``turn`` (3, 3) is from the axes at rest to those as seen."""
        if self.motion is Motion.GRAB:
            return Asked(self.motion, by=self._on_screen() @ turn)
        if any(self.aside):
            x, y = np.multiply(self.aside, self.view.metres_per_pixel)
            aside = x * self.view.right + y * self.view.up
            return Asked(self.motion, self._amount(), by=aside @ turn)
        return Asked(self.motion, self._amount())

    def _amount(self) -> float:
        if self.typed is not None:
            return self.sign * self.typed
        match self.motion:
            case Motion.TWIST:
                return self.sign * self.distance / self.radius
            case Motion.PINCH:
                return self.sign * min(PINCH_SHARE * self.distance / self.radius, MOST_PINCHED)
        pen = self.pressure * PEN_DEPTH * self.size * self.strength
        return self.sign * (self.distance + pen)

    def _on_screen(self) -> Array:
        """Way (3,) in the plane of the view, axes of the body as seen."""
        x, y = self._way
        way: Array = x * self.view.right + y * self.view.up
        if self.typed is None:
            return way
        along = way / self.distance if self.distance > 0.0 else self.view.up
        return self.typed * along

    @property
    def _way(self) -> Array:
        pixels = np.subtract(self.cursor, self.start).astype(np.float64)
        return pixels * self.view.metres_per_pixel * self.strength
