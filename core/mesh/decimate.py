"""Decimation before tetrahedralization, whose time grows with the number of triangles."""

from __future__ import annotations

import numpy as np

from ..machine.absent_library import library
from .coordinates import UnitBox
from .surface import Surface

# Diagonal that a surface is scaled to: fast_simplification's thresholds are absolute, and at a size
# of 1 or less they admit collapses that displace the surface by its own radius.
DIAGONAL = 1e4


def decimate(surface: Surface, most_triangles: int) -> Surface:
    """Reduce a surface to about ``most_triangles`` by edge collapse with quadric errors.

    Returns the surface itself where it is small enough. Where only slivers are left, as at the
    poles of a fine sphere, more triangles remain.

    Raises
    ------
    PalpateError
        It has to be reduced, and there is no fast-simplification for this system.
    """
    if len(surface.triangles) <= most_triangles:
        return surface
    fast_simplification = library("fast_simplification", "fast-simplification")
    box = UnitBox.of(surface.vertices)
    vertices, triangles = fast_simplification.simplify(
        (DIAGONAL * box.enter(surface.vertices)).astype(np.float32),
        surface.triangles.astype(np.int32),
        target_count=most_triangles,
    )
    return Surface(box.leave(vertices.astype(np.float64) / DIAGONAL), triangles.astype(np.int64))
