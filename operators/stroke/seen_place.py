"""Place of a soft object under the pointer."""

from __future__ import annotations

import bpy
from bpy_extras import view3d_utils

from ..scene.viewport import Viewport
from . import touched_place
from .touched_place import TouchedPlace


def seen_place(
    scene: bpy.types.Scene, graph: bpy.types.Depsgraph, here: Viewport
) -> TouchedPlace | None:
    """Place of a soft object under a pointer, as it is drawn.

    Raises
    ------
    PalpateError
        The object's transform flattens it.
    """
    origin = view3d_utils.region_2d_to_origin_3d(here.region, here.region_3d, here.cursor)
    along = view3d_utils.region_2d_to_vector_3d(here.region, here.region_3d, here.cursor)
    return touched_place.under_ray(scene, graph, origin, along)
