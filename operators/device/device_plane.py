"""Default plane of a device with two axes: upright through the object's top."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Half extents (m) of the arms' reach, x and y, before the device sends them.
HAPLY_HALF_EXTENTS = {"kit": (0.045, 0.025)}
USUAL_HALF_EXTENTS = (0.06, 0.035)
# The plane's x is the world's X, its y is up.
UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def half_extents(model: str) -> tuple[float, float]:
    """Half extents of a Haply 2DIY's workspace, metres."""
    return HAPLY_HALF_EXTENTS.get(model, USUAL_HALF_EXTENTS)


def upright_plane(thing: bpy.types.Object) -> Array:
    """World matrix (4, 4) of an upright plane through the surface above the middle of the
    object; where there is none, as in a ring, through the top of its bounding box.
    """
    corners = np.array([thing.matrix_world @ Vector(corner) for corner in thing.bound_box])
    top = (corners.min(axis=0) + corners.max(axis=0)) / 2
    top[2] = corners[:, 2].max()
    matrix = np.eye(4)
    matrix[:3, :3] = UPRIGHT
    matrix[:3, 3] = _below(thing, top)
    return matrix


def _below(thing: bpy.types.Object, place: Array) -> Array:
    """Point of the object vertically below ``place``; ``place`` if there is none."""
    if not thing.visible_get():
        return place
    to_local = thing.matrix_world.inverted_safe()
    origin = to_local @ Vector((place[0], place[1], place[2] + 1e-3))
    direction = (to_local.to_3x3() @ Vector((0.0, 0.0, -1.0))).normalized()
    met, point, *_ = thing.ray_cast(origin, direction)
    return np.array(thing.matrix_world @ point) if met else place
