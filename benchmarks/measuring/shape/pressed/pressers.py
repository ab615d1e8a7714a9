"""Rigid tools without anything of Palpate's: how deep places are in them.

All but the wall are a core grown by a ball. A place's way out leads from the core's nearest point;
the normal bends with the place in those directions in which that point does not go along.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Depths:
    """How deep places are in a tool.

    Attributes
    ----------
    depth : (p,), metres; negative outside.
    normals : (p, 3), outwards, unit.
    bends : (p, 3, 3), how the normals change with the place, per metre; symmetric.
    """

    depth: Array
    normals: Array
    bends: Array


class Presser(Protocol):
    """What is pressed in."""

    def depths(self, places: Array) -> Depths:
        """How deep places (p, 3) are in it."""
        ...


@dataclass(frozen=True, eq=False)
class Ball:
    """A ball about ``middle`` (3,)."""

    middle: Array
    radius: float

    def depths(self, places: Array) -> Depths:
        """See :class:`Presser`."""
        return _grown(places - self.middle, self.radius, np.eye(3)[None])


@dataclass(frozen=True, eq=False)
class Wall:
    """All beyond a plane through ``place`` (3,), on the side of ``outward`` (3,), unit.

    ``friction`` is Coulomb's coefficient; only a body that nothing holds is held by it.
    """

    place: Array
    outward: Array
    friction: float = 0.0

    def depths(self, places: Array) -> Depths:
        """See :class:`Presser`."""
        depth = (places - self.place) @ self.outward
        normals = np.tile(-self.outward, (len(places), 1))
        return Depths(depth, normals, np.zeros((len(places), 3, 3)))


@dataclass(frozen=True, eq=False)
class Rod:
    """A rod with round ends about ``middle`` (3,), as long along ``axis`` (3,), unit, as twice
    ``reach`` without them.
    """

    middle: Array
    axis: Array
    reach: float
    radius: float

    def depths(self, places: Array) -> Depths:
        """See :class:`Presser`."""
        away = places - self.middle
        along = away @ self.axis
        away = away - np.clip(along, -self.reach, self.reach)[:, None] * self.axis
        goes_along = np.abs(along) < self.reach
        stays = np.eye(3) - goes_along[:, None, None] * np.outer(self.axis, self.axis)
        return _grown(away, self.radius, stays)


@dataclass(frozen=True, eq=False)
class Block:
    """A box with rounded edges about ``middle`` (3,), its axes the columns of ``turn`` (3, 3), as
    long along them as twice ``reach`` (3,) without the rounding by ``radius``.
    """

    middle: Array
    turn: Array
    reach: Array
    radius: float

    def depths(self, places: Array) -> Depths:
        """See :class:`Presser`."""
        own = (places - self.middle) @ self.turn
        away = own - np.clip(own, -self.reach, self.reach)
        stays = np.einsum("ia,pa,ja->pij", self.turn, np.abs(own) > self.reach, self.turn)
        beside = _grown(away @ self.turn.T, self.radius, stays)
        # Within the core the way out leads through the nearest side, and does not bend.
        inside = np.all(away == 0.0, axis=1)
        under = self.reach - np.abs(own)
        side = under.argmin(axis=1)
        depth = np.where(inside, self.radius + under.min(axis=1), beside.depth)
        signs = np.sign(np.take_along_axis(own, side[:, None], axis=1))
        normals = np.where(inside[:, None], signs * self.turn[:, side].T, beside.normals)
        return Depths(depth, normals, np.where(inside[:, None, None], 0.0, beside.bends))


def _grown(away: Array, radius: float, stays: Array) -> Depths:
    """Of places (p, 3) from the core's nearest points, which do not go along in the directions of
    ``stays``, projections (p or 1, 3, 3).
    """
    distance = np.linalg.norm(away, axis=1)
    clear = np.maximum(distance, 1e-300)
    normals = away / clear[:, None]
    bends = (stays - normals[:, :, None] * normals[:, None, :]) / clear[:, None, None]
    return Depths(radius - distance, normals, bends)
