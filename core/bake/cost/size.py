"""Sizes of surfaces and meshes that the cost of a bake depends on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh.surface import Surface
from ...mesh.tet_mesh import TetMesh
from ...mesh.winding_volume import enclosed_volume
from .crossing import crossing_length

# Edges sharper than this are features of the shape, which need no finer triangles.
SHARP_EDGE = np.radians(60.0)


@dataclass(frozen=True)
class ShapeSize:
    """Size of a surface.

    Attributes
    ----------
    area : of the surface, square metres.
    volume : enclosed, cubic metres.
    diagonal : of its bounding box, metres.
    triangles : their number.
    bending : see :func:`bending`, metres; None to assume a body as round as its volume allows.
    crossing : length along which it passes through itself, metres.
    """

    area: float
    volume: float
    diagonal: float
    triangles: int
    bending: float | None = None
    crossing: float = 0.0

    @classmethod
    def of(cls, surface: Surface) -> ShapeSize:
        """Measure a surface; for open or overlapping ones this takes up to a second."""
        welded = surface.welded()
        return cls(
            float(welded.areas.sum()),
            enclosed_volume(welded),
            welded.diagonal,
            len(welded.triangles),
            bending(welded),
            crossing_length(welded),
        )


@dataclass(frozen=True)
class MeshSize:
    """Size of a tetrahedral mesh: counts of its nodes."""

    nodes: int
    surface_nodes: int

    @classmethod
    def of(cls, mesh: TetMesh) -> MeshSize:
        """Count a mesh's nodes."""
        return cls(len(mesh.nodes), len(mesh.surface_nodes))


def bending(surface: Surface) -> float:
    """Total bending of the surface, metres: half of edge length times angle, summed.

    On a smooth surface this is the integral of the mean curvature. Sharp edges do not count.
    """
    triangles = surface.triangles
    i, j, k = (surface.vertices[triangles[:, corner]] for corner in range(3))
    normals = np.cross(j - i, k - i)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    starts, ends = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    edge = np.minimum(starts, ends) * len(surface.vertices) + np.maximum(starts, ends)
    order = np.argsort(edge)
    first, second = order[:-1], order[1:]
    paired = edge[first] == edge[second]
    first, second = first[paired], second[paired]
    cosine = np.einsum("ex,ex->e", normals[first // 3], normals[second // 3])
    # Opposite normals are usually those of inconsistent winding.
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    along = surface.vertices[ends[first]] - surface.vertices[starts[first]]
    lengths = np.linalg.norm(along, axis=1)
    return float(0.5 * (lengths * angle)[angle < SHARP_EDGE].sum())
