"""How thick a body gives way under a place, and how much of that a push leaves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.grip.patch import Grip
from ...object.drawn_body import DrawnBody
from ...place import ray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Thickness:
    """Body under a place, straight in.

    Attributes
    ----------
    metres : to the far side, or until a ball meets what is pinned before that, at rest.
    inward : float64 (3,), unit vector straight in.
    nodes : int64 (3,), of the triangle there, or three times the pinned one.
    alpha : float64 (3,), area coordinates in it.
    pinned : whether it is what is pinned.
    """

    metres: float
    inward: Array
    nodes: NDArray[np.int64]
    alpha: Array
    pinned: bool = False

    @classmethod
    def under(cls, drawn: DrawnBody, grip: Grip) -> Thickness | None:
        """Thickness under a grip; None where no far side is found, as at a sharp edge."""
        sides = (cls._far(drawn, grip), cls._core(drawn, grip))
        found = [side for side in sides if side is not None]
        return min(found, key=lambda side: side.metres, default=None)

    @classmethod
    def _far(cls, drawn: DrawnBody, grip: Grip) -> Thickness | None:
        mesh = drawn.body.mesh
        # The far side is seen from within.
        triangles = mesh.surface_triangles[:, ::-1]
        met = ray.first_hit(grip.centre(mesh), -grip.normal, mesh.nodes, triangles)
        if met is None:
            return None
        return cls(met.distance, -grip.normal, triangles[met.triangle], met.alpha)

    @classmethod
    def _core(cls, drawn: DrawnBody, grip: Grip) -> Thickness | None:
        """The inner pinned node that a ball as wide as the grip meets first: a core may be thinner
        than the ball, and beside its middle's way.
        """
        mesh = drawn.body.mesh
        held = np.setdiff1d(drawn.body.fixed, mesh.surface_nodes)
        from_here = mesh.nodes[held] - grip.centre(mesh)
        ahead = from_here @ -grip.normal
        aside = np.linalg.norm(from_here + np.outer(ahead, grip.normal), axis=1)
        met = np.flatnonzero((ahead > 0.0) & (aside < grip.radius))
        if not len(met):
            return None
        depths = ahead[met] + grip.radius - np.sqrt(grip.radius**2 - aside[met] ** 2)
        first = held[met[depths.argmin()]]
        node, alpha = np.full(3, first), np.array([1.0, 0.0, 0.0])
        return cls(float(depths.min()), -grip.normal, node, alpha, pinned=True)

    def gone(self, depth: float, moved: Array) -> float:
        """Metres of it that are gone at a depth, metres, with displacements (N, 3) of all nodes: a
        part that gives way as a whole is squeezed little.
        """
        return depth - float(self.alpha @ moved[self.nodes] @ self.inward)
