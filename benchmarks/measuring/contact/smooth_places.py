"""Places on a body's surface to slide over, with the angles between the facets about them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.winding_volume import is_inside

Vectors = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Place:
    """A place with a direction along the surface.

    Attributes
    ----------
    at : float64 (3,), metres, on the surface.
    normal, along : float64 (3,), unit vectors, outward and across it.
    bend : largest angle between neighbouring facets within reach, degrees.
    """

    at: Vectors
    normal: Vectors
    along: Vectors
    bend: float


@dataclass(frozen=True, eq=False)
class Facets:
    """The surface of a body, and how its facets meet."""

    body: SoftBody

    @cached_property
    def nodes(self) -> Vectors:
        """Float64 (s, 3), metres."""
        return self.body.mesh.nodes[self.body.mesh.surface_nodes]

    @cached_property
    def triangles(self) -> NDArray[np.int64]:
        """Int64 (m, 3), surface-local."""
        return self.body.mesh.surface_local_triangles

    @cached_property
    def normals(self) -> Vectors:
        """Unit normals (m, 3)."""
        a, b, c = (self.nodes[self.triangles[:, corner]] for corner in range(3))
        across = np.cross(b - a, c - a)
        unit: Vectors = across / np.linalg.norm(across, axis=1)[:, None]
        return unit

    @cached_property
    def _edges(self) -> tuple[Vectors, Vectors, Vectors]:
        """Middles (e, 3) and lengths (e,) of edges, and angles (e,) of the facets there, deg."""
        edges = np.sort(self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        order = np.lexsort(edges.T)
        sides = np.repeat(np.arange(len(self.triangles)), 3)[order].reshape(-1, 2)
        ends = self.nodes[edges[order][::2]]
        cosines = np.einsum("ex,ex->e", self.normals[sides[:, 0]], self.normals[sides[:, 1]])
        lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return ends.mean(axis=1), lengths, np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))

    @cached_property
    def edge(self) -> float:
        """Mean length of an edge, metres."""
        return float(self._edges[1].mean())

    def bend(self, at: Vectors, reach: float) -> float:
        """The largest angle between neighbouring facets about a place, degrees."""
        middles, lengths, angles = self._edges
        near = np.linalg.norm(middles - at, axis=1) < reach + 0.5 * lengths
        return float(angles[near].max(initial=0.0))

    def places(self, bends: tuple[float, float], reach: float, count: int) -> list[Place]:
        """Facets away from pins, the largest angle about them within ``bends``, far from each
        other, where the body is at least 1.5 reaches thick; the most bent first.
        """
        pinned = self.nodes[self.body.free_index(self.body.mesh.surface_nodes) < 0]
        centres = self.nodes[self.triangles].mean(axis=1)
        bent = np.array([self.bend(centre, reach) for centre in centres])
        chosen: list[Place] = []
        for number in np.argsort(-bent, kind="stable"):
            at, normal = centres[number], self.normals[number]
            if not bends[0] <= bent[number] <= bends[1]:
                continue
            if np.linalg.norm(pinned - at, axis=1).min(initial=np.inf) < 1.5 * reach:
                continue
            if any(np.linalg.norm(place.at - at) < 2.0 * reach for place in chosen):
                continue
            within = at - np.linspace(0.1, 1.5, 8)[:, None] * reach * normal
            if not is_inside(within, Surface(self.nodes, self.triangles)).all():
                continue
            corner = self.nodes[self.triangles[number, 0]]
            side = np.cross(normal, corner - at)
            chosen.append(Place(at, normal, side / np.linalg.norm(side), float(bent[number])))
            if len(chosen) == count:
                break
        return chosen
