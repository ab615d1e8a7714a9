"""Imprint of a drawn surface while it is pressed."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.imprint.imprint import Imprint
from ...core.imprint.yielding import Yielding
from ..scene.body_frame import BodyFrame

Flat = NDArray[np.float32]


def yielding_of(thing: bpy.types.Object, frame: BodyFrame) -> Yielding:
    """How an object yields, by its settings."""
    chosen = thing.palpate
    return Yielding(chosen.yield_depth * frame.metres_per_unit, chosen.forget_time)


@dataclass(eq=False)
class SurfaceImprint:
    """Imprint of the drawn vertices of an object with this frame, by their flat displacements
    (3 p,), local units. Only vertices that have moved beyond the yield depth take part.
    """

    frame: BodyFrame
    _imprint: Imprint = field(default_factory=lambda: Imprint.none(0), init=False)
    _rows: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64), init=False)
    _time: float = field(default=0.0, init=False)

    @property
    def is_left(self) -> bool:
        """Whether anything stays once it is let go."""
        return bool(self._imprint.left.any())

    def left(self, count: int) -> Flat:
        """What stays once it is let go, of so many vertices."""
        flat = np.zeros((count, 3), dtype=np.float32)
        flat[self._rows] = self.frame.local_from_body(self._imprint.left)
        return flat.ravel()

    def fades(self, law: Yielding) -> bool:
        """Whether it changes while nothing moves."""
        return law.forget > 0.0 and self.is_left

    def seen(self, law: Yielding, moved: Flat, seconds: float) -> Flat:
        """What is seen at a time (s, any clock) of a surface that the contact has ``moved``."""
        vectors, metric = moved.reshape(-1, 3), self.frame.metric
        if not law.elastic:
            # No direction is stretched further than the longest.
            nearest = law.depth / np.linalg.norm(metric, ord=2)
            self._take(np.flatnonzero(np.einsum("pi,pi->p", vectors, vectors) > nearest**2))
        passed, self._time = seconds - self._time, seconds
        if not len(self._rows):
            return moved
        metres = vectors[self._rows] @ metric
        self._imprint = self._imprint.pressed(law, metres, passed)
        shown = moved.copy()
        shown.reshape(-1, 3)[self._rows] = self.frame.local_from_body(self._imprint.seen(metres))
        return shown

    def settle(self) -> None:
        """The next contact begins on the surface as it is."""
        self._imprint = self._imprint.settled()

    def _take(self, rows: NDArray[np.int64]) -> None:
        """Let more vertices take part."""
        new = np.setdiff1d(rows, self._rows, assume_unique=True)
        if len(new):
            self._rows = np.concatenate([self._rows, new])
            self._imprint = self._imprint.with_more(len(new))
