"""Digest of an object's vertex groups."""

from __future__ import annotations

import bpy
import numpy as np

from ..scene import fingerprint
from ..scene.drawn_surface import group_weights

# Step for comparing weights; finer differences are rounding.
STEP = 1e-3


def group_digest(thing: bpy.types.Object, group: bpy.types.VertexGroup) -> str:
    """Short text that changes with the group's weights."""
    steps = np.rint(group_weights(thing.data, group.index) / STEP)
    return fingerprint.digest(steps.astype(np.int64))
