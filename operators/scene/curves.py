"""Animation curves, in files of all Blenders that we know."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def bags(animated: bpy.types.ID) -> list[bpy.types.bpy_prop_collection]:
    """The curves of a datablock, in bundles."""
    data = animated.animation_data
    return [] if data is None or data.action is None else _bags_of(data.action)


def _bags_of(action: bpy.types.Action) -> list[bpy.types.bpy_prop_collection]:
    if hasattr(action, "fcurves"):
        return [action.fcurves]
    return [
        bag.fcurves
        for layer in action.layers
        for strip in layer.strips
        for bag in strip.channelbags
    ]


def is_animated(animated: bpy.types.ID, path: str) -> bool:
    """Whether keyframes or a driver move a property of a datablock."""
    data = animated.animation_data
    driven = data is not None and data.drivers.find(path) is not None
    return driven or any(bag.find(path) is not None for bag in bags(animated))


def remove(animated: bpy.types.ID, path: str) -> None:
    """Remove keyframes and driver of a property of a datablock, where it has any."""
    animated.driver_remove(path)
    for bag in bags(animated):
        for curve in [one for one in bag if one.data_path == path]:
            bag.remove(curve)


def curves(animated: bpy.types.ID) -> Iterator[bpy.types.FCurve]:
    """All curves of a datablock."""
    for bag in bags(animated):
        yield from bag


def key_straight(animated: bpy.types.ID, path: str, first_frame: int, values: Array) -> None:
    """Key a property in every frame, with straight lines in between.

    Parameters
    ----------
    path : of the property.
    values : (n,) or (n, k), a row a frame from ``first_frame`` on.
    """
    columns = values.reshape(len(values), -1).T
    animated.keyframe_insert(path, frame=first_frame)
    for curve in curves(animated):
        if curve.data_path != path:
            continue
        points = np.column_stack([first_frame + np.arange(len(values)), columns[curve.array_index]])
        curve.keyframe_points.add(len(values) - len(curve.keyframe_points))
        curve.keyframe_points.foreach_set("co", points.ravel())
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
        curve.update()


@contextmanager
def kept(animated: Iterable[bpy.types.ID]) -> Iterator[None]:
    """What is animated has its present values afterwards, also those that were set by hand and not
    keyed: to evaluate another frame overwrites them.
    """
    before = [
        (holder, name, value)
        for one in animated
        for path in _animated_paths(one)
        for holder, name in _holders(one, path)
        for value in [_value(holder, name)]
    ]
    try:
        yield
    finally:
        for holder, name, value in before:
            if _value(holder, name) == value:
                continue
            if name.startswith("["):
                holder[name[2:-2]] = value
            else:
                setattr(holder, name, value)


def _animated_paths(animated: bpy.types.ID) -> set[str]:
    """Paths of all properties that curves of a datablock move, in strips too."""
    data = getattr(animated, "animation_data", None)
    if data is None:
        return set()
    strips = (strip for track in data.nla_tracks for strip in track.strips)
    actions = {data.action, *(strip.action for strip in strips)} - {None}
    return {curve.data_path for action in actions for bag in _bags_of(action) for curve in bag}


def _holders(animated: bpy.types.ID, path: str) -> list[tuple[Any, str]]:
    """What has the property at a path, with the rest of the path; nothing where the path leads
    nowhere, as Blender allows.
    """
    start = path.rindex("[") if path.endswith("]") else path.rfind(".") + 1
    above, name = path[:start].removesuffix("."), path[start:]
    try:
        animated.path_resolve(path)
        return [(animated.path_resolve(above) if above else animated, name)]
    except ValueError:
        return []


def _value(holder: Any, name: str) -> Any:
    value = holder.path_resolve(name)
    return value if isinstance(value, str) or not hasattr(value, "__len__") else tuple(value)
