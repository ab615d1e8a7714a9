"""Corner of a view where nothing is that is looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# What is looked at is taken for its shadow along these many directions: a polygon around it.
DIRECTIONS = 16


@dataclass(frozen=True)
class Room:
    """Part of a view that no region, button or text of Blender's covers, pixels."""

    left: float
    bottom: float
    right: float
    top: float


def free_corner(size: tuple[float, float], room: Room, shown: Array) -> tuple[float, float] | None:
    """Lower left corner of a rectangle of this size (width, height) that lies in a corner of the
    room, else at the middle of a side, clear of the places ``shown`` (n, 2); None where there is
    no such place.
    """
    width, height = size
    left, bottom, right, top = room.left, room.bottom, room.right - width, room.top - height
    if right < left or top < bottom:
        return None
    across, up = 0.5 * (left + right), 0.5 * (bottom + top)
    corners = [(left, bottom), (right, bottom), (left, top), (right, top)]
    sides = [(left, up), (right, up), (across, bottom), (across, top)]
    return next((place for place in corners + sides if not _covers(place, size, shown)), None)


def _covers(place: tuple[float, float], size: tuple[float, float], shown: Array) -> bool:
    """Whether a rectangle meets the polygon around some places."""
    if not len(shown):
        return False
    angles = np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    axes = np.stack([np.cos(angles), np.sin(angles)])
    x, y = np.array(place), np.array(place) + size
    corners = np.array([(x[0], x[1]), (y[0], x[1]), (x[0], y[1]), (y[0], y[1])])
    own, theirs = corners @ axes, shown @ axes
    apart = (own.max(axis=0) < theirs.min(axis=0)) | (own.min(axis=0) > theirs.max(axis=0))
    return not apart.any()
