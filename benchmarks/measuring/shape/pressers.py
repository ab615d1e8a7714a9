"""Rigid tools without anything of Palpate's: how deep places are in them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Presser(Protocol):
    """What is pressed in."""

    def depths(self, places: Array) -> tuple[Array, Array]:
        """How deep places (p, 3) are in it, (p,), and its outward normals there, (p, 3)."""
        ...


@dataclass(frozen=True, eq=False)
class Ball:
    """A ball about ``middle`` (3,)."""

    middle: Array
    radius: float

    def depths(self, places: Array) -> tuple[Array, Array]:
        """See :class:`Presser`."""
        away = places - self.middle
        distance = np.linalg.norm(away, axis=1)
        return self.radius - distance, away / distance[:, None]


@dataclass(frozen=True, eq=False)
class Wall:
    """All beyond a plane through ``place`` (3,), on the side of ``outward`` (3,), unit."""

    place: Array
    outward: Array

    def depths(self, places: Array) -> tuple[Array, Array]:
        """See :class:`Presser`."""
        return (places - self.place) @ self.outward, np.tile(-self.outward, (len(places), 1))
