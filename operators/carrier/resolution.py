"""Resolution that a dent needs: faces of the drawn mesh that are too coarse for it are divided."""

from __future__ import annotations

import math

import bpy
import numpy as np

from ..layer import stack
from ..scene.drawn_surface import DrawnSurface

# A fingertip, as a share of the body's size: that of the scene at first.
FINGERTIP = 0.05
# Faces up to the fingertip's radius are not divided, others until they are half of it.
FINE = 0.5
MOST_FACES = 100_000
# What may follow divided faces, since it moves flat ones as it moves whole ones.
_MAY_FOLLOW = frozenset({"ARMATURE", "MESH_CACHE", "WEIGHTED_NORMAL"})


def halvings(thing: bpy.types.Object, surface: DrawnSurface, *, as_seen: bool) -> int:
    """How often the faces of a surface are halved so that it can show the dent of a fingertip."""
    made_by = stack.making(thing) if as_seen else []
    if not set(stack.following(thing, made_by)) <= _MAY_FOLLOW or not len(surface.face_starts):
        return 0
    radius = FINGERTIP * float(np.linalg.norm(np.ptp(surface.body, axis=0)))
    length = _typical_edge(surface)
    if length <= radius:
        return 0
    wanted = math.ceil(math.log2(length / (FINE * radius)))
    corners = len(surface.corners)
    # The first division makes a face of each corner.
    allowed = 1 + math.floor(math.log(max(MOST_FACES / corners, 0.25), 4.0))
    return max(0, min(wanted, allowed))


def _typical_edge(surface: DrawnSurface) -> float:
    """Edge of a square as wide as the faces in which half of the area is, metres."""
    places = surface.body[surface.corners]
    counts = np.diff(surface.face_starts, append=len(surface.corners))
    middles = np.add.reduceat(places, surface.face_starts) / counts[:, None]
    away = np.linalg.norm(places - np.repeat(middles, counts, axis=0), axis=1)
    lengths = np.sort(math.sqrt(2.0) * np.maximum.reduceat(away, surface.face_starts))
    share = np.cumsum(lengths**2)
    return float(lengths[np.searchsorted(share, 0.5 * share[-1])])
