"""Keyframes of an object that nobody holds, where it was in each frame."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from ...core.errors import PalpateError
from ..lying import rest_layer
from ..lying.laid import CHANNELS, is_animated, place, remember
from ..scene import curves
from ..scene.body_frame import BodyFrame

ROTATIONS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


def refuse_others(thing: bpy.types.Object) -> None:
    """Refuse an object that other keyframes than baked ones place.

    Raises
    ------
    PalpateError
        With the remedy.
    """
    if is_animated(thing) and not thing.palpate.is_keyed:
        raise PalpateError(
            "{name}: keyframes or drivers place it, and what nothing pins moves by itself; clear "
            "them, or choose other Pins",
            name=thing.name,
        )


def key_places(
    thing: bpy.types.Object,
    frames: Sequence[int],
    places: Sequence[BodyFrame],
    floor: float | None,
) -> None:
    """Key an object in each frame where it was; the first is where it is from then on, and the
    layer goes that shows how it rested.
    """
    remember(thing, floor)
    for channel in CHANNELS:
        curves.remove(thing, channel)
    rotation = ROTATIONS.get(thing.rotation_mode, "rotation_euler")
    before = None
    for frame, here in zip(frames, places, strict=True):
        place(thing, here)
        if before is not None and rotation != "rotation_axis_angle":
            turned = getattr(thing, rotation).copy()
            # A turn goes on, instead of coming back the other way.
            turned.make_compatible(before)
            setattr(thing, rotation, turned)
        before = getattr(thing, rotation).copy() if rotation != "rotation_axis_angle" else None
        for channel in ("location", rotation):
            thing.keyframe_insert(channel, frame=frame)
    for curve in curves.curves(thing):
        if curve.data_path in CHANNELS:
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"
    thing.palpate.is_keyed = True
    rest_layer.remove(thing)
