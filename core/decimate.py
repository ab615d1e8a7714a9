"""Fewer triangles before tetrahedralization, whose time grows with their number."""

from __future__ import annotations

import fast_simplification
import numpy as np

from .surface import Surface


def decimate(surface: Surface, most_triangles: int) -> Surface:
    """Reduce a surface to about ``most_triangles`` by edge collapse with quadric errors.

    Returns the surface itself where it is small enough already.
    """
    if len(surface.triangles) <= most_triangles:
        return surface
    vertices, triangles = fast_simplification.simplify(
        surface.vertices.astype(np.float32),
        surface.triangles.astype(np.int32),
        target_count=most_triangles,
    )
    return Surface(vertices.astype(np.float64), triangles.astype(np.int64))
