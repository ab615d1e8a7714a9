"""Weights of an object's vertex groups."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..scene import fingerprint

# Step for comparing weights; finer differences are rounding.
STEP = 1e-3


def group_weights(thing: bpy.types.Object, group: bpy.types.VertexGroup) -> NDArray[np.float64]:
    """Weight of the group at every vertex, (p,), 0 where a vertex is not in it."""
    weights = np.zeros(len(thing.data.vertices))
    for vertex in thing.data.vertices:
        for membership in vertex.groups:
            if membership.group == group.index:
                weights[vertex.index] = membership.weight
    return weights


def group_digest(thing: bpy.types.Object, group: bpy.types.VertexGroup) -> str:
    """Short text that changes with the group's weights."""
    steps = np.rint(group_weights(thing, group) / STEP)
    return fingerprint.digest(steps.astype(np.int64))
