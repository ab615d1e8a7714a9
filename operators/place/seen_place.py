"""Place of a soft object under the pointer, as it was evaluated last: nothing is evaluated anew."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import metres_per_unit
from ..scene.viewport import Viewport
from . import drawn_meshes, seen_triangle

Array = NDArray[np.float64]

# How objects are shown that hide nothing.
SEEN_THROUGH = frozenset({"BOUNDS", "WIRE"})
# What is hidden lies behind what hides it by more than rounding, as a share of the way to it.
BEFORE = 1.0 - 1e-5


@dataclass(frozen=True, eq=False)
class SeenPlace:
    """Place on the mesh as evaluated.

    Attributes
    ----------
    thing : the object.
    frame : of the object, or of its instance that is under the pointer.
    seen, normal : float64 (3,), place and outward unit normal, world coordinates.
    """

    thing: bpy.types.Object
    frame: BodyFrame
    seen: Array
    normal: Array


def under_pointer(
    scene: bpy.types.Scene, graph: bpy.types.Depsgraph, here: Viewport
) -> SeenPlace | None:
    """Place on the first object under a pointer, if that is a soft one.

    Raises
    ------
    PalpateError
        Its transform flattens it; it is in no collection that is shown.
    """
    return under_ray(scene, graph, *here.line_of_sight())


def under_ray(
    scene: bpy.types.Scene, graph: bpy.types.Depsgraph, origin: Array, direction: Array
) -> SeenPlace | None:
    """Place on the first object that a ray meets, world coordinates, if that is a soft one.

    Raises
    ------
    PalpateError
        Its transform flattens it; it is in no collection that is shown.
    """
    start, along = np.array(origin, dtype=np.float64), np.array(direction, dtype=np.float64)
    met = _first_soft(graph, start, along)
    if met is None or _is_hidden(graph, Vector(start), Vector(met.seen)):
        return None
    if met.thing.name not in bpy.context.view_layer.objects:
        raise PalpateError(
            "{name} is seen as an instance alone; show the collection that it is in, too",
            name=met.thing.name,
        )
    frame = BodyFrame.of_matrix(met.matrix, metres_per_unit(scene))
    return SeenPlace(met.thing, frame, met.seen, met.normal)


@dataclass(frozen=True, eq=False)
class _Met:
    """Soft object or instance on a ray: its matrix, and the place with its outward unit normal."""

    thing: bpy.types.Object
    matrix: Array
    away: float
    seen: Array
    normal: Array


def _first_soft(graph: bpy.types.Depsgraph, origin: Array, direction: Array) -> _Met | None:
    first = None
    for thing, placed in drawn_meshes.on_ray(graph, origin, direction):
        if not thing.original.palpate.body_key:
            continue
        matrix = np.array(placed)
        turn = matrix[:3, :3]
        if not np.linalg.det(turn):
            continue
        into = np.linalg.inv(turn)
        start, along = into @ (origin - matrix[:3, 3]), into @ direction
        if not _meets(thing.bound_box, start.tolist(), along.tolist()):
            continue
        found = seen_triangle.first_on_ray(thing.data, start, along)
        if found is not None and (first is None or found.away < first.away):
            seen = turn @ found.place + matrix[:3, 3]
            i, j, k = found.corners
            normal = np.cross(j - i, k - i) @ into
            normal /= np.linalg.norm(normal)
            first = _Met(thing.original, matrix, found.away, seen, normal)
    return first


def _is_hidden(graph: bpy.types.Depsgraph, eye: Vector, seen: Vector) -> bool:
    """Whether something that is not soft is between an eye and what it sees. Of each such mesh
    Blender keeps a tree, since it does not change while another is pressed.
    """
    way = np.array(seen - eye)
    for thing, matrix in drawn_meshes.on_ray(graph, np.array(eye), way, BEFORE):
        if thing.display_type in SEEN_THROUGH or thing.original.palpate.body_key:
            continue
        into = matrix.inverted_safe()
        start = into @ eye
        along = into @ seen - start
        if _meets(thing.bound_box, start, along, BEFORE):
            met, *_ = thing.ray_cast(start, along, distance=BEFORE * along.length)
            if met:
                return True
    return False


def _meets(
    box: Sequence[Sequence[float]],
    start: Sequence[float],
    along: Sequence[float],
    farthest: float = math.inf,
) -> bool:
    """Whether a ray goes through a box of Blender's, no farther than so many of its lengths."""
    enters, leaves = 0.0, farthest
    margin = drawn_meshes.MARGIN * math.dist(box[0], box[6])
    for axis in range(3):
        low, high = box[0][axis] - margin - start[axis], box[6][axis] + margin - start[axis]
        if along[axis] == 0.0:
            if low > 0.0 or high < 0.0:
                return False
            continue
        near, far = sorted((low / along[axis], high / along[axis]))
        enters, leaves = max(enters, near), min(leaves, far)
    return enters <= leaves
