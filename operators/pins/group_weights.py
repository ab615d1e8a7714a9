"""What is painted into an object's vertex groups."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..scene import fingerprint

# Weights are compared in steps of this: finer differences are rounding, not paint.
STEP = 1e-3


def group_weights(thing: bpy.types.Object, group: bpy.types.VertexGroup) -> NDArray[np.float64]:
    """The group's weight at every vertex, (p,), 0 where a vertex is not in it."""
    weights = np.zeros(len(thing.data.vertices))
    for vertex in thing.data.vertices:
        for membership in vertex.groups:
            if membership.group == group.index:
                weights[vertex.index] = membership.weight
    return weights


def group_digest(thing: bpy.types.Object, group: bpy.types.VertexGroup) -> str:
    """A short text that changes when somebody paints in the group."""
    steps = np.rint(group_weights(thing, group) / STEP)
    return fingerprint.digest(steps.astype(np.int64))
