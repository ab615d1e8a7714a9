"""Motions of a grip: every one is a sum of five fields, so their answers add up too.

With r the place from the grip's centre and n the normal there, the fields are the three
translations, the swirl n x r, and the drawing in -(r - n (n.r)). A turn by an angle t about n
moves r by sin(t) (n x r) - (1 - cos(t)) (r - n (n.r)): a sum of the last two, exact for any angle.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

FIELDS = 5


def fields_at(places: Array, centre: Array, normal: Array) -> Array:
    """The five fields at ``places`` (k, 3), (k, 3, 5); ``centre`` (3,), ``normal`` (3,) unit."""
    arms = places - centre
    fields = np.zeros((len(places), 3, FIELDS))
    fields[:, :, :3] = np.eye(3)
    fields[:, :, 3] = np.cross(normal, arms)
    fields[:, :, 4] = np.outer(arms @ normal, normal) - arms
    return fields


def moved(by: ArrayLike) -> Array:
    """Shares (5,) of the fields in a translation ``by`` (3,), metres."""
    return np.concatenate([np.asarray(by, dtype=np.float64), np.zeros(2)])


def turned(angle: float) -> Array:
    """Shares (5,) of the fields in a turn about the normal by ``angle``, radians."""
    return np.array([0.0, 0.0, 0.0, math.sin(angle), 1.0 - math.cos(angle)])


def drawn_in(share: float) -> Array:
    """Shares (5,) of the fields in drawing places in by a ``share`` of their way to the axis.

    1 would bring them onto the axis; negative ones spread them.
    """
    return np.array([0.0, 0.0, 0.0, 0.0, share])
