"""How thick a body gives way under a place, and how much of that a push leaves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.grip.patch import Grip
from ...object.drawn_body import DrawnBody
from ...scene import ray

Array = NDArray[np.float64]
Triangles = NDArray[np.int64]
# Corners of a tetrahedron's sides.
SIDES = ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))


@dataclass(frozen=True, eq=False)
class Thickness:
    """Body under a place, straight in.

    Attributes
    ----------
    metres : to the far side, or to what is pinned before that, at rest.
    inward : float64 (3,), unit vector from the place to there.
    nodes : int64 (3,), of the triangle there.
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
        mesh = drawn.body.mesh
        # The far side is seen from within.
        far = mesh.surface_triangles[:, ::-1]
        sides = [cls._met(drawn, grip, far), cls._met(drawn, grip, _within(drawn), pinned=True)]
        found = [side for side in sides if side is not None]
        return min(found, key=lambda side: side.metres) if found else None

    @classmethod
    def _met(
        cls, drawn: DrawnBody, grip: Grip, triangles: Triangles, *, pinned: bool = False
    ) -> Thickness | None:
        mesh = drawn.body.mesh
        met = ray.first_hit(grip.centre(mesh), -grip.normal, mesh.nodes, triangles)
        if met is None:
            return None
        return cls(met.distance, -grip.normal, triangles[met.triangle], met.alpha, pinned)

    def gone(self, depth: float, moved: Array) -> float:
        """Metres of it that are gone at a depth, metres, with displacements (N, 3) of all nodes: a
        part that gives way as a whole is squeezed little.
        """
        return depth - float(self.alpha @ moved[self.nodes] @ self.inward)


def _within(drawn: DrawnBody) -> Triangles:
    """Sides of tetrahedra that are pinned and not of the surface, each wound both ways (k, 3)."""
    body = drawn.body
    pinned = np.zeros(len(body.mesh.nodes), dtype=bool)
    pinned[body.fixed] = True
    pinned[body.mesh.surface_nodes] = False
    sides = body.mesh.tets[:, SIDES].reshape(-1, 3)
    held = sides[pinned[sides].all(axis=1)]
    return np.concatenate([held, held[:, ::-1]])
