"""How thick a body is under a place, and how much of that a push leaves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.grip.patch import Grip
from ...object.drawn_body import DrawnBody
from ...scene import ray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Thickness:
    """Body under a place, straight in.

    Attributes
    ----------
    metres : to the far side, at rest.
    inward : float64 (3,), unit vector from the place to there.
    nodes : int64 (3,), of the triangle there.
    alpha : float64 (3,), area coordinates in it.
    """

    metres: float
    inward: Array
    nodes: NDArray[np.int64]
    alpha: Array

    @classmethod
    def under(cls, drawn: DrawnBody, grip: Grip) -> Thickness | None:
        """Thickness under a grip; None where no far side is found, as at a sharp edge."""
        mesh = drawn.body.mesh
        # The far side is seen from within.
        inside_out = mesh.surface_triangles[:, ::-1]
        met = ray.first_hit(grip.centre(mesh), -grip.normal, mesh.nodes, inside_out)
        if met is None:
            return None
        return cls(met.distance, -grip.normal, inside_out[met.triangle], met.alpha)

    def gone(self, depth: float, moved: Array) -> float:
        """Metres of it that are gone at a depth, metres, with displacements (N, 3) of all nodes: a
        part that gives way as a whole is squeezed little.
        """
        return depth - float(self.alpha @ moved[self.nodes] @ self.inward)
