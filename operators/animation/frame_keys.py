"""Shape keys of an animation: each at full value in its frame, fading to its neighbours."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..kept.layer_operator import shared_refusal
from ..layer import layers
from ..object.drawn_body import DrawnBody
from ..scene import curves
from .frames.pressed_frames import PressedFrame

FRAME_NAME = "Press at"


def refuse(thing: bpy.types.Object) -> None:
    """Refuse an object that shape keys cannot play an animation for.

    Raises
    ------
    PalpateError
        More vertices are drawn than it has, or others share its mesh.
    """
    if layers.carrier(thing) is not None:
        raise PalpateError(
            "{name}: shape keys hold its own vertices alone, and more of them are drawn; keep the "
            "animation as Mesh Cache",
            name=thing.name,
        )
    if shared_refusal(thing):
        raise PalpateError(shared_refusal(thing))


def keep_frames(thing: bpy.types.Object, drawn: DrawnBody, pressed: list[PressedFrame]) -> int:
    """Keep the frames as shape keys that fade into each other; returns how many."""
    if thing.data.shape_keys is None:
        thing.shape_key_add(name="Basis", from_mix=False)
    _remove_frames(thing)
    count = 0
    for number, here in enumerate(pressed):
        if here.moved is None:
            continue
        key = thing.shape_key_add(name=f"{FRAME_NAME} {here.frame}", from_mix=False)
        key.relative_key = thing.data.shape_keys.reference_key
        key.points.foreach_set("co", here.coordinates(drawn))
        for other, value in ((number - 1, 0.0), (number, 1.0), (number + 1, 0.0)):
            if 0 <= other < len(pressed):
                key.value = value
                key.keyframe_insert("value", frame=pressed[other].frame)
        count += 1
    _go_straight(thing.data.shape_keys)
    thing.data.update()
    return count


def plays(thing: bpy.types.Object) -> bool:
    """Whether the object has shape keys of an animation."""
    keys = thing.data.shape_keys
    return keys is not None and any(
        key.name.startswith(f"{FRAME_NAME} ") for key in keys.key_blocks
    )


def _remove_frames(thing: bpy.types.Object) -> None:
    """Remove the remains of an earlier press along an animation."""
    keys = thing.data.shape_keys
    for key in [key for key in keys.key_blocks if key.name.startswith(f"{FRAME_NAME} ")]:
        path = f'key_blocks["{key.name}"].value'
        for bag in curves.bags(keys):
            curve = bag.find(path)
            if curve is not None:
                bag.remove(curve)
        thing.shape_key_remove(key)


def _go_straight(keys: bpy.types.Key) -> None:
    """Values that go in straight lines add up to one between two frames."""
    for curve in curves.curves(keys):
        if curve.data_path.startswith(f'key_blocks["{FRAME_NAME} '):
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"
