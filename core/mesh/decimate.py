"""Decimation before tetrahedralization, whose time grows with the number of triangles."""

from __future__ import annotations

import fast_simplification
import numpy as np

from .surface import Surface

# Diagonal that a surface is scaled to: fast_simplification's thresholds are absolute, and at a size
# of 1 or less they admit collapses that displace the surface by its own radius.
DIAGONAL = 1e4


def decimate(surface: Surface, most_triangles: int) -> Surface:
    """Reduce a surface to about ``most_triangles`` by edge collapse with quadric errors.

    Returns the surface itself where it is small enough. Where only slivers are left, as at the
    poles of a fine sphere, more triangles remain.
    """
    if len(surface.triangles) <= most_triangles:
        return surface
    middle = 0.5 * (surface.vertices.min(axis=0) + surface.vertices.max(axis=0))
    scale = DIAGONAL / np.linalg.norm(np.ptp(surface.vertices, axis=0))
    vertices, triangles = fast_simplification.simplify(
        (scale * (surface.vertices - middle)).astype(np.float32),
        surface.triangles.astype(np.int32),
        target_count=most_triangles,
    )
    return Surface(vertices.astype(np.float64) / scale + middle, triangles.astype(np.int64))
