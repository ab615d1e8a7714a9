"""Object under a press: whether it is still what the press began with."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..layer import layers, live_layer, place_marks
from ..object.drawn_body import DrawnBody
from ..place import touched_place
from ..place.touched_place import TouchedPlace
from ..scene.drawn_surface import frame_of

Array = NDArray[np.float64]


def reason_to_end(thing: bpy.types.Object | None, drawn: DrawnBody, *, withdrawn: bool) -> str:
    """Reason why a press cannot continue on an object, {name} for its name; empty if it can."""
    if thing is None:
        return "{name} was deleted; pressing has ended"
    if thing.mode != "OBJECT":
        return "{name} is being edited; pressing has ended"
    if 3 * len(layers.drawn_mesh(thing).vertices) != len(drawn.rest):
        return "{name} was edited; press Make Soft to bake it again"
    if not withdrawn and live_layer.find(thing) is None:
        return "{name} has lost its live layer; pressing has ended"
    return ""


def moved_along(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    drawn: DrawnBody,
    place: TouchedPlace | None,
    finger: Array | None = None,
) -> tuple[DrawnBody | None, TouchedPlace | None]:
    """The body where the object is now, in the local frame of a place; None if it was scaled,
    sheared or flattened. And that place: the touched one as it is seen now, or the nearest one to a
    ``finger`` (3,) that is free, world coordinates; None at rest.
    """
    try:
        frame = frame_of(thing, scene)
    except PalpateError:
        # A flattened object has changed its scale too.
        return None, place
    if finger is not None and place_marks.hung(thing):
        place = touched_place.nearest(thing, frame, finger)
    elif place is not None:
        place = place.followed(thing, frame)
    return drawn.moved_to(frame if place is None else place.frame(frame)), place
