"""The map W from the body's free surface nodes to the vertices that are drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from .soft_body import SoftBody


@dataclass(frozen=True, eq=False)
class DrawnMap:
    """Each drawn vertex hangs on its nearest surface triangle and moves as that place does.

    Attributes
    ----------
    weights : W, sparse (p, n): area coordinates, without the pinned nodes, which do not move.
    normals : float64 (p, 3), outward unit normals of the triangles that they hang on, at rest.
    """

    weights: csr_array
    normals: NDArray[np.float64]

    @classmethod
    def hang(cls, vertices: NDArray[np.float64], body: SoftBody) -> DrawnMap:
        """Hang ``vertices`` (p, 3), metres in body coordinates, on the body's rest surface."""
        triangles = body.mesh.surface_triangles
        places = body.closest_points.query(vertices)
        corners = triangles[places.triangle]
        column = body.free_index(corners)
        moves = column >= 0
        row = np.broadcast_to(np.arange(len(corners))[:, None], corners.shape)
        weights = csr_array(
            (places.alpha[moves], (row[moves], column[moves])),
            shape=(len(corners), body.compliance.node_count),
        )
        i, j, k = (body.mesh.nodes[corners[:, corner]] for corner in range(3))
        normals = np.cross(j - i, k - i)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return cls(weights, normals)

    def displacements(self, free_surface: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (p, 3) of drawn vertices from those of the free surface nodes (n, 3)."""
        moved: NDArray[np.float64] = self.weights @ free_surface
        return moved
