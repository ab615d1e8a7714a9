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
    (3 p,), local units.
    """

    frame: BodyFrame
    _imprint: Imprint | None = field(default=None, init=False)
    _time: float = field(default=0.0, init=False)

    @property
    def left(self) -> Flat | None:
        """What stays once it is let go; None where nothing has yielded."""
        if self._imprint is None or not (left := self._imprint.left).any():
            return None
        return self._local(left)

    def fades(self, law: Yielding) -> bool:
        """Whether it changes while nothing moves."""
        return self._imprint is not None and law.forget > 0.0

    def seen(self, law: Yielding, moved: Flat, seconds: float) -> Flat:
        """What is seen at a time (s, any clock) of a surface that the contact has ``moved``."""
        if self._imprint is None and law.elastic:
            return moved
        metres = moved.reshape(-1, 3) @ self.frame.metric
        before = self._imprint or Imprint.none(len(metres))
        self._imprint = before.pressed(law, metres, seconds - self._time)
        self._time = seconds
        return self._local(self._imprint.seen(metres))

    def settle(self) -> None:
        """The next contact begins on the surface as it is."""
        if self._imprint is not None:
            self._imprint = self._imprint.settled()

    def _local(self, metres: NDArray[np.float64]) -> Flat:
        return self.frame.local_from_body(metres).astype(np.float32).ravel()
