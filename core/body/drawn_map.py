"""The map W from the body's free surface nodes to the vertices that are drawn.

The surface of the tetrahedra is flat between its nodes and mostly coarser than what is drawn on it:
displacements linear in each triangle would show its edges in every dent. So each triangle carries a
cubic one, of the values at its nodes and of slopes found there from the nodes around: G. Farin,
*Triangular Bernstein-Bezier patches* (1986), with the middle point that keeps quadratics. It is the
same on both sides of an edge, smooth at the nodes, and linear where the nodes' displacements are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from palpate_servo import CubicPlaces, closest_points
from scipy.sparse import csr_array

from .soft_body import SoftBody

# Mean square of the directions to the nodes around, along the normal, from which on these tell the
# slope across the surface, as at an edge of the body; below it is damped, and none in a plane.
STEEP_AROUND = 0.1


@dataclass(frozen=True, eq=False)
class DrawnMap:
    """Each drawn vertex hangs on its nearest surface triangle and moves as that place does.

    Attributes
    ----------
    triangle : int64 (p,), of the surface, on which each vertex hangs.
    normals : float64 (t, 3), outward unit normals of the surface's triangles, at rest.
    beside : sparse (h, n): Bezier values beside the ends of each edge, from displacements of the
        free surface nodes. Pinned nodes do not move and have no slope.
    controls : int64 (t, 9): of each triangle the values at its corners, and beside them, in the
        order of ``places``, by their numbers in those of the nodes, the edges, and a zero.
    places : of the vertices in their triangles.
    """

    triangle: NDArray[np.int64]
    normals: NDArray[np.float64]
    beside: csr_array
    controls: NDArray[np.int64]
    places: CubicPlaces

    @classmethod
    def hang(cls, vertices: NDArray[np.float64], body: SoftBody) -> DrawnMap:
        """Hang ``vertices`` (p, 3), metres in body coordinates, on the body's rest surface."""
        nodes, triangles = body.mesh.nodes, body.mesh.surface_triangles
        triangle, alpha = closest_points(nodes, triangles, vertices)
        edges = _edges(triangles)
        edges = edges[body.free_index(edges[:, 0]) >= 0]
        i, j, k = (nodes[triangles[:, corner]] for corner in range(3))
        normals = np.cross(j - i, k - i)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        places = CubicPlaces(triangle, alpha, len(triangles))
        return cls(triangle, normals, _beside(edges, body), _controls(edges, body), places)

    def displacements(
        self, free_surface: NDArray[np.float64], into: NDArray[np.float32] | None = None
    ) -> NDArray[np.float32]:
        """Displacements (p, 3) of drawn vertices from those of the free surface nodes (n, 3); in
        an array of that shape that the caller keeps, ``into``, or in a new one.
        """
        known = np.concatenate([free_surface, self.beside @ free_surface, np.zeros((1, 3))])
        ends = known[self.controls]
        # With this value in the middle the patch keeps quadratics.
        middle = ends[:, 3:].sum(axis=1) / 4.0 - ends[:, :3].sum(axis=1) / 6.0
        moved = np.empty((len(self.triangle), 3), dtype=np.float32) if into is None else into
        self.places.write(np.concatenate([ends, middle[:, None]], axis=1), moved)
        return moved


def _edges(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Both directions (h, 2) of all edges, ascending."""
    pairs = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    return np.unique(np.concatenate([pairs, pairs[:, ::-1]]), axis=0)


def _controls(edges: NDArray[np.int64], body: SoftBody) -> NDArray[np.int64]:
    """Numbers (t, 9) of the values at the corners of all triangles, and beside them."""
    corners, free = body.mesh.surface_triangles, body.compliance.node_count
    zero = free + len(edges)
    ends = corners[:, [0, 0, 1, 1, 2, 2]], corners[:, [1, 2, 0, 2, 0, 1]]
    code = np.array([len(body.mesh.nodes), 1])
    numbers = np.searchsorted(edges @ code, np.stack(ends, axis=-1) @ code)
    at, begin = body.free_index(corners), body.free_index(ends[0])
    beside = np.where(begin >= 0, free + numbers, zero)
    return np.concatenate([np.where(at >= 0, at, zero), beside], axis=1)


def _beside(edges: NDArray[np.int64], body: SoftBody) -> csr_array:
    """At a third of the edge: the value at its beginning, and a third of the slope there along it.

    The slope is the least-squares one over all edges that begin at the node.
    """
    nodes, free = body.mesh.nodes, body.compliance.node_count
    begin, end = edges.T
    away = nodes[end] - nodes[begin]
    unit = away / np.linalg.norm(away, axis=1, keepdims=True)
    seen = np.zeros((len(nodes), 3, 3))
    np.add.at(seen, begin, unit[:, :, None] * unit[:, None, :])
    normals = _normals(body)
    across = np.einsum("nx,nxy,ny->n", normals, seen, normals)
    lacking = np.maximum(0.0, STEEP_AROUND * np.trace(seen, axis1=1, axis2=2) - across)
    seen += lacking[:, None, None] * normals[:, :, None] * normals[:, None, :]
    slopes = np.linalg.solve(
        seen[begin], (away / np.sum(away**2, axis=1, keepdims=True))[..., None]
    )
    each, other = _pairs(begin)
    share = np.einsum("ex,ex->e", slopes[other, :, 0], away[each]) / 3.0
    # A third of the way from u_begin towards each u_end, in the shares of the slope.
    at, of = body.free_index(begin), body.free_index(end[other])
    moves = of >= 0
    rows = [np.arange(len(edges)), each, each[moves]]
    columns = [at, at[each], of[moves]]
    values = [np.ones(len(edges)), -share, share[moves]]
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return csr_array(entries, (len(edges), free))


def _pairs(begin: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of edges that begin at the same node; ``begin`` is ascending."""
    _, first, node, valence = np.unique(
        begin, return_index=True, return_inverse=True, return_counts=True
    )
    counts = valence[node]
    each = np.repeat(np.arange(len(begin)), counts)
    within = np.arange(len(each)) - np.repeat(np.cumsum(counts) - counts, counts)
    return each, first[node][each] + within


def _normals(body: SoftBody) -> NDArray[np.float64]:
    """Unit normals (N, 3) of the surface at its nodes; zero inside."""
    triangles, nodes = body.mesh.surface_triangles, body.mesh.nodes
    i, j, k = (nodes[triangles[:, corner]] for corner in range(3))
    normals = np.zeros_like(nodes)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], np.cross(j - i, k - i))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    return normals
