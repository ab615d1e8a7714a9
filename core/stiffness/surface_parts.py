"""Connected parts of a surface, and which lie inside others, as a bone in flesh."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..mesh.decimate import decimate
from ..mesh.surface import Surface
from ..mesh.tet_mesh import pieces
from ..mesh.winding_volume import is_inside

# Triangles of a part at most for deciding inside or outside.
TRIANGLES_FOR_SIDES = 400

# Sample points of a part that decide whether it lies inside another.
PLACES_OF_A_PART = 64


@dataclass(frozen=True, eq=False)
class SurfacePart:
    """Connected triangles.

    Attributes
    ----------
    triangles : int64 (f, 3), vertex numbers of the surface.
    outline : the part alone, decimated; for deciding inside or outside.
    """

    triangles: NDArray[np.int64]
    outline: Surface

    @classmethod
    def of(cls, surface: Surface, triangles: NDArray[np.int64]) -> SurfacePart:
        """Make the part of some ``triangles`` (f, 3) of the surface."""
        used, corners = np.unique(triangles, return_inverse=True)
        alone = Surface(surface.vertices[used], corners.reshape(-1, 3))
        return cls(triangles, decimate(alone.welded(), TRIANGLES_FOR_SIDES))

    @cached_property
    def box(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest corner of its bounding box, (3,) each, metres."""
        return self.outline.vertices.min(axis=0), self.outline.vertices.max(axis=0)

    def encloses(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Mask (p,) of the ``points`` (p, 3) that it encloses."""
        low, high = self.box
        near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        enclosed = np.zeros(len(points), dtype=np.bool_)
        enclosed[near] = is_inside(points[near], self.outline)
        return enclosed

    def lies_in(self, other: SurfacePart) -> bool:
        """Whether most of it is inside the other part."""
        (low, high), (other_low, other_high) = self.box, other.box
        if (low > other_high).any() or (high < other_low).any():
            return False
        corners = self.outline.vertices
        step = max(1, len(corners) // PLACES_OF_A_PART)
        return bool(other.encloses(corners[::step]).mean() > 0.5)


@dataclass(frozen=True, eq=False)
class NestedParts:
    """Parts of a surface, by nesting.

    Attributes
    ----------
    inner : the parts that lie inside others, the smallest first.
    outer : triangles (f, 3) of all the others.
    """

    inner: list[SurfacePart]
    outer: NDArray[np.int64]


def nested_parts(surface: Surface) -> NestedParts:
    """Separate a surface's inner parts from its outer ones."""
    parts = surface_parts(surface)
    inner = [
        any(part.lies_in(larger) for larger in parts[index + 1 :])
        for index, part in enumerate(parts)
    ]
    return NestedParts(
        [part for part, is_inner in zip(parts, inner, strict=True) if is_inner],
        np.concatenate(
            [part.triangles for part, is_inner in zip(parts, inner, strict=True) if not is_inner]
        ),
    )


def surface_parts(surface: Surface) -> list[SurfacePart]:
    """All parts, the smallest first. Coinciding vertices are connected: seams do not separate."""
    corners = surface.coinciding()[1][surface.triangles]
    label = pieces(corners, int(corners.max()) + 1)[corners[:, 0]]
    order = np.argsort(label, kind="stable")
    starts = np.flatnonzero(np.diff(label[order])) + 1
    parts = [
        SurfacePart.of(surface, surface.triangles[members]) for members in np.split(order, starts)
    ]
    return sorted(parts, key=lambda part: part.outline.diagonal)
