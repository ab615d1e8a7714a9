"""What a stroke asks of the body: a kind of motion and how much of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ....core.grip import motions

Array = NDArray[np.float64]


class Motion(Enum):
    """Kind of a stroke."""

    PUSH = "push"  # along the inward normal; a negative depth pulls
    GRAB = "grab"  # along with the pointer, in the plane of the view
    TWIST = "twist"  # about the normal
    PINCH = "pinch"  # towards the normal; a negative share spreads


@dataclass(frozen=True, eq=False)
class Asked:
    """Motion and its amount.

    Attributes
    ----------
    motion : its kind.
    amount : depth of a push, metres; angle of a twist, radians; share of a pinch.
    by : float64 (3,), way of a grab, or of a push along the surface, metres, axes of the body at
        rest.
    """

    motion: Motion
    amount: float = 0.0
    by: Array | None = None

    @property
    def nothing(self) -> bool:
        """Whether nothing moves."""
        return self.amount == 0.0 and (self.by is None or not self.by.any())

    def part(self, share: float) -> Asked:
        """A share of it."""
        by = None if self.by is None else share * self.by
        return replace(self, amount=share * self.amount, by=by)

    def shares(self, normal: Array) -> Array:
        """Shares (5,) of a grip's fields, with the outward unit normal (3,) of its place."""
        match self.motion:
            case Motion.TWIST:
                return motions.turned(self.amount)
            case Motion.PINCH:
                return motions.drawn_in(self.amount)
            case Motion.GRAB if self.by is not None:
                return motions.moved(self.by)
        along = np.zeros(3) if self.by is None else self.by
        return motions.moved(along - self.amount * normal)
