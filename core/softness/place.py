"""Place on a body's rest surface, with the inward direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..body.soft_body import SoftBody
from ..contact.near_field.contact_points import smooth_corner_normals
from ..errors import PalpateError
from ..mesh.coordinates import refuse_unusable
from ..sentence import Sentence
from .parallel_rays import crossings


@dataclass(frozen=True, eq=False)
class Place:
    """Attributes
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


def thickness(body: SoftBody, place: Place) -> float:
    """Thickness of the body along the axis, metres."""
    met = crossings(body.mesh, place.position[None], place.axis)
    size = float(np.ptp(body.mesh.nodes, axis=0).max())
    leaving = met.heights[~met.inward & (met.heights > 1e-9 * size)]
    return float(leaving.min(initial=size))
