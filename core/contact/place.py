"""Places on a body's rest surface, their inward directions, and the compliance between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..body.soft_body import SoftBody
from ..errors import PalpateError
from ..mesh.coordinates import refuse_unusable
from ..sentence import Sentence
from .equations import coupled_compliance
from .near_field.surface_shape import smooth_corner_normals


@dataclass(frozen=True, eq=False)
class Place:
    """Place on a body's rest surface.

    Attributes
    ----------
    position : float64 (3,), metres.
    axis : float64 (3,), unit vector into the body, against the smooth normal.
    triangle : number of the surface triangle.
    alpha : float64 (3,), area coordinates there.
    """

    position: NDArray[np.float64]
    axis: NDArray[np.float64]
    triangle: int
    alpha: NDArray[np.float64]

    def pinned(self, body: SoftBody) -> bool:
        """Whether a node of this place's triangle is pinned."""
        corners = body.mesh.surface_triangles[self.triangle][self.alpha > 0]
        return bool(np.isin(corners, body.fixed).any())


def nearest_place(body: SoftBody, at: ArrayLike) -> Place:
    """Place nearest to ``at`` (3,), metres.

    Raises
    ------
    PalpateError
        Not three finite numbers.
    """
    point = np.asarray(at, dtype=np.float64)
    if point.shape != (3,):
        raise PalpateError(
            "place: {point} is not a point; give three finite numbers in metres",
            point=point.tolist(),
        )
    refuse_unusable(Sentence("place"), point[None])
    nearest = body.closest_points.query(point)
    triangle, alpha = int(nearest.triangle[0]), nearest.alpha[0]
    axis = -(alpha @ smooth_corner_normals(body.mesh)[triangle])
    return Place(nearest.position[0], axis / np.linalg.norm(axis), triangle, alpha)


def compliance_between(
    body: SoftBody, triangles: ArrayLike, alphas: ArrayLike
) -> NDArray[np.float64]:
    """C_pq at unit modulus, (m, m, 3, 3), between places on triangles (m,) with alphas (m, 3).

    C_pq is how far place p moves per newton on place q; see :func:`.equations.coupled_compliance`.
    """
    local = body.mesh.surface_local_triangles[np.asarray(triangles, dtype=np.int64)]
    count = len(local)
    blocks = body.surface_blocks(local, local).reshape(count, 3, count, 3, 3, 3)
    return coupled_compliance(blocks, alphas)
