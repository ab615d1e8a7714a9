"""Fewer triangles before tetrahedralization, whose time grows with their number."""

from __future__ import annotations

import fast_simplification
import numpy as np

from .surface import Surface

# Diagonal that a surface is scaled to: the thresholds of fast_simplification are absolute, and at a
# size of 1 or less even collapses that tear the surface out by its own radius pass them.
DIAGONAL = 1e4


def decimate(surface: Surface, most_triangles: int) -> Surface:
    """Reduce a surface to about ``most_triangles`` by edge collapse with quadric errors.

    Returns the surface itself where it is small enough already. Where only slivers are left, as at
    the poles of a fine sphere, more triangles remain than were asked for.
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
