"""Resolution that a dent needs: faces of the drawn mesh that are too coarse for it are divided."""

from __future__ import annotations

import math

import bpy
import numpy as np

from ..layer import stack
from ..scene.drawn_surface import DrawnSurface

# A fingertip, as a share of the body's size: that of the scene at first.
FINGERTIP = 0.05
# Faces are divided until they are so much of the fingertip's radius: flat ones above that, for a
# dent stretches them to twice their size; smooth ones only where it would be lost between vertices.
FINE, COARSE_SMOOTH = 0.3, 1.0
# Share of the area whose faces are judged; a dent may be anywhere, but few wide ones do not count.
JUDGED = 0.9
MOST_FACES = 100_000
# What may follow divided faces, since it moves flat ones as it moves whole ones, or none. All else
# would make another shape of them, without any dent: subdivision a sharper one, Lattice a rounder.
_MAY_FOLLOW = frozenset(
    [
        "ARMATURE",
        "MESH_CACHE",
        "UV_PROJECT",
        "UV_WARP",
        "VERTEX_WEIGHT_EDIT",
        "VERTEX_WEIGHT_MIX",
        "VERTEX_WEIGHT_PROXIMITY",
        "WEIGHTED_NORMAL",
    ]
)


def halvings(thing: bpy.types.Object, surface: DrawnSurface, *, as_seen: bool) -> int:
    """How often the faces of a surface are halved so that it can show the dent of a fingertip."""
    made_by = stack.making(thing) if as_seen else []
    if not set(stack.following(thing, made_by)) <= _MAY_FOLLOW or not len(surface.face_starts):
        return 0
    radius = FINGERTIP * float(np.linalg.norm(np.ptp(surface.body, axis=0)))
    length = _wide_edge(surface)
    if length <= (COARSE_SMOOTH if _is_smooth(thing) else FINE) * radius:
        return 0
    wanted = math.ceil(math.log2(length / (FINE * radius)))
    corners = len(surface.corners)
    # The first division makes a face of each corner.
    allowed = 1 + math.floor(math.log(max(MOST_FACES / corners, 0.25), 4.0))
    return max(0, min(wanted, allowed))


def _is_smooth(thing: bpy.types.Object) -> bool:
    """Whether most faces of an object are shaded smooth."""
    smooth = np.zeros(len(thing.data.polygons), dtype=np.bool_)
    thing.data.polygons.foreach_get("use_smooth", smooth)
    return bool(2 * np.count_nonzero(smooth) > len(smooth))


def _wide_edge(surface: DrawnSurface) -> float:
    """Edge of a square as wide as the widest of the judged faces, metres."""
    places = surface.body[surface.corners]
    counts = np.diff(surface.face_starts, append=len(surface.corners))
    middles = np.add.reduceat(places, surface.face_starts) / counts[:, None]
    away = np.linalg.norm(places - np.repeat(middles, counts, axis=0), axis=1)
    lengths = np.sort(math.sqrt(2.0) * np.maximum.reduceat(away, surface.face_starts))
    share = np.cumsum(lengths**2)
    return float(lengths[np.searchsorted(share, JUDGED * share[-1])])
