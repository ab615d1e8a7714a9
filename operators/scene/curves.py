"""Animation curves, in files of all Blenders that we know."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def bags(animated: bpy.types.ID) -> list[bpy.types.bpy_prop_collection]:
    """The curves of a datablock, in bundles."""
    data = animated.animation_data
    if data is None or data.action is None:
        return []
    if hasattr(data.action, "fcurves"):
        return [data.action.fcurves]
    return [
        bag.fcurves
        for layer in data.action.layers
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
        curve = bag.find(path)
        if curve is not None:
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
