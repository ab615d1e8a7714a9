"""Object under a press: whether it is still what the press began with, and where its places are."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..layer import layers, live_layer, place_marks
from ..object.drawn_body import DrawnBody
from ..place import touched_place
from ..place.touched_place import TouchedPlace
from ..scene.body_frame import BodyFrame
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
    thing: bpy.types.Object, scene: bpy.types.Scene, drawn: DrawnBody
) -> DrawnBody | None:
    """The body where the object is now; None if it was scaled, sheared or flattened."""
    try:
        return drawn.moved_to(frame_of(thing, scene))
    except PalpateError:
        # A flattened object has changed its scale too.
        return None


def places_along(
    thing: bpy.types.Object,
    frame: BodyFrame,
    places: Sequence[TouchedPlace | None],
    free: Sequence[Array | None],
) -> tuple[TouchedPlace | None, ...]:
    """Each finger's place: the touched one as it is seen now, or the nearest one to a finger that
    is ``free``, (3,), world coordinates; None at rest. ``frame`` is the object's.
    """
    marked = place_marks.hung(thing)
    return tuple(
        touched_place.nearest(thing, frame, finger)
        if marked and finger is not None
        else None
        if place is None
        else place.followed(thing, frame)
        for place, finger in zip(places, free, strict=True)
    )


def local_frames(frame: BodyFrame, places: Sequence[TouchedPlace | None]) -> tuple[BodyFrame, ...]:
    """Local frame of each finger's place, by the object's."""
    return tuple(frame if place is None else place.frame(frame) for place in places)
