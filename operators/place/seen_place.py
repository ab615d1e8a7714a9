"""Place of a soft object under the pointer, as it was evaluated last: nothing is evaluated anew."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import metres_per_unit
from ..scene.viewport import Viewport

Array = NDArray[np.float64]


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
    start, along = Vector(origin), Vector(direction)
    met, place, normal, _, thing, matrix = scene.ray_cast(graph, start, along)
    if not met or thing is None or thing.type != "MESH" or not thing.original.palpate.body_key:
        return None
    if thing.original.name not in bpy.context.view_layer.objects:
        raise PalpateError(
            "{name} is seen as an instance alone; show the collection that it is in, too",
            name=thing.original.name,
        )
    frame = BodyFrame.of_matrix(np.array(matrix), metres_per_unit(scene))
    return SeenPlace(thing.original, frame, np.array(place), np.array(normal))
