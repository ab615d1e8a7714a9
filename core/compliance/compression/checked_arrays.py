"""Validation of the compressed arrays of a body file."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import PalpateError

PREFIX = "compressed_"

# Allowed kinds of numbers of each array, and its number of axes.
LAYOUT: dict[str, tuple[tuple[type[np.generic], ...], int]] = {
    "column_error": ((np.float64,), 0),
    "places": ((np.int32,), 1),
    "own_blocks": ((np.float64,), 3),
    "near_scale": ((np.float32,), 2),
    "near_table": ((np.int32,), 2),
    "near_steps": ((np.float32,), 1),
    "near": ((np.int16, np.float32), 3),
    "tile_counts": ((np.int32,), 1),
    "basis": ((np.float32,), 1),
    "steps": ((np.float32,), 1),
    "tile_table": ((np.int32,), 2),
    "narrow": ((np.int8,), 3),
    "wide": ((np.int16, np.int32), 3),
}


def checked(node_count: int, arrays: dict[str, NDArray[np.generic]]) -> dict[str, Any]:
    """The arrays by their names without prefix, contiguous.

    Raises
    ------
    PalpateError
        An array that is missing, of another type or shape, with numbers that are not finite, or
        that points beyond another.
    """
    parts: dict[str, Any] = {}
    for name, (kinds, axes) in LAYOUT.items():
        array = arrays.get(PREFIX + name)
        if array is None:
            raise _damaged(f"{PREFIX}{name} is missing")
        if array.dtype not in kinds or array.ndim != axes:
            raise _damaged(f"{PREFIX}{name} is {array.dtype} with {array.ndim} axes")
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            raise _damaged(f"{PREFIX}{name} has numbers that are not finite")
        parts[name] = np.ascontiguousarray(array).reshape(array.shape)
    _refuse_wrong_shapes(node_count, parts)
    _refuse_wrong_numbers(parts)
    return parts


def _refuse_wrong_shapes(node_count: int, parts: dict[str, NDArray[Any]]) -> None:
    clusters, padded = parts["near_scale"].shape
    tiles = int(parts["tile_counts"].sum(dtype=np.int64))
    rows = 8 * int(parts["tile_counts"].sum(dtype=np.int64)) * padded
    expected: dict[str, tuple[int, ...]] = {
        "places": (node_count,),
        "own_blocks": (node_count, 3, 3),
        "near_table": (clusters, clusters),
        "near": (len(parts["near_steps"]), padded, padded),
        "tile_counts": (clusters,),
        "basis": (rows,),
        "steps": (clusters,),
        "tile_table": (tiles, tiles),
        "narrow": (max(1, len(parts["narrow"])), 8, 8),
        "wide": (len(parts["wide"]), 8, 8),
    }
    for name, shape in expected.items():
        if parts[name].shape != shape:
            raise _damaged(f"{PREFIX}{name} has the shape {parts[name].shape}, not {shape}")
    if padded % 3 or clusters * padded < 3 * node_count:
        raise _damaged(f"{clusters} clusters of {padded} rows do not hold {node_count} nodes")


def _refuse_wrong_numbers(parts: dict[str, NDArray[Any]]) -> None:
    places, counts = parts["places"], parts["tile_counts"]
    limits = {
        "places": (0, parts["near_scale"].size // 3 - 1),
        "near_table": (0, len(parts["near"])),
        "tile_table": (-len(parts["wide"]), len(parts["narrow"]) - 1),
        "tile_counts": (0, len(parts["tile_table"])),
    }
    for name, (lowest, highest) in limits.items():
        array = parts[name]
        if array.size and (array.min() < lowest or array.max() > highest):
            raise _damaged(f"{PREFIX}{name} has numbers beyond {lowest} to {highest}")
    if len(np.unique(places)) != len(places) or np.any(np.diff(counts) < 0):
        raise _damaged("its clusters contradict each other")
    if not np.all(parts["near_table"].diagonal()):
        raise _damaged("a cluster is no neighbour of itself")
    for name in ("near_table", "tile_table"):
        if not np.array_equal(parts[name], parts[name].T):
            raise _damaged(f"{PREFIX}{name} is not symmetric")


def _damaged(reason: str) -> PalpateError:
    return PalpateError("compressed compliance: {reason}; bake the body again", reason=reason)
