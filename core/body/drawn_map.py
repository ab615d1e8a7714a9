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
from palpate_servo import closest_points
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
    beside : sparse (h, n): Bezier values beside the ends of each edge, from displacements of the
        free surface nodes. Pinned nodes do not move and have no slope.
    weights : sparse (p, n + h): of the nodes, and of the places beside them.
    normals : float64 (p, 3), outward unit normals of the triangles that they hang on, at rest.
    """

    beside: csr_array
    weights: csr_array
    normals: NDArray[np.float64]

    @classmethod
    def hang(cls, vertices: NDArray[np.float64], body: SoftBody) -> DrawnMap:
        """Hang ``vertices`` (p, 3), metres in body coordinates, on the body's rest surface."""
        triangles = body.mesh.surface_triangles
        triangle, alpha = closest_points(body.mesh.nodes, triangles, vertices)
        edges = _edges(triangles)
        edges = edges[body.free_index(edges[:, 0]) >= 0]
        weights = _weights(alpha, triangles[triangle], edges, body)
        i, j, k = (body.mesh.nodes[triangles[triangle, corner]] for corner in range(3))
        normals = np.cross(j - i, k - i)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return cls(_beside(edges, body), weights, normals)

    def displacements(self, free_surface: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (p, 3) of drawn vertices from those of the free surface nodes (n, 3)."""
        known = np.concatenate([free_surface, self.beside @ free_surface])
        moved: NDArray[np.float64] = self.weights @ known
        return moved


def _edges(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Both directions (h, 2) of all edges, ascending."""
    pairs = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    return np.unique(np.concatenate([pairs, pairs[:, ::-1]]), axis=0)


def _weights(
    alpha: NDArray[np.float64],
    corners: NDArray[np.int64],
    edges: NDArray[np.int64],
    body: SoftBody,
) -> csr_array:
    """Bernstein polynomials at area coordinates (p, 3) in triangles (p, 3)."""
    count, free = len(alpha), body.compliance.node_count
    middle = alpha.prod(axis=1)
    # The value in the middle is that of the ends of the edges, a quarter each, less a sixth of the
    # corners.
    ends = corners[:, [0, 0, 1, 1, 2, 2]], corners[:, [1, 2, 0, 2, 0, 1]]
    code = np.array([len(body.mesh.nodes), 1])
    numbers = np.searchsorted(edges @ code, np.stack(ends, axis=-1) @ code)
    beside = np.where(body.free_index(ends[0]) >= 0, free + numbers, -1)
    along = 3.0 * alpha[:, [0, 0, 1, 1, 2, 2]] ** 2 * alpha[:, [1, 2, 0, 2, 0, 1]]
    column = np.concatenate([body.free_index(corners), beside], axis=1)
    value = np.concatenate([alpha**3 - middle[:, None], along + 1.5 * middle[:, None]], axis=1)
    counts = (column >= 0) & (value != 0.0)
    # Rows are in order, and short indices are quicker to read.
    ends_of_rows = np.concatenate([[0], np.cumsum(counts.sum(axis=1))]).astype(np.int32)
    numbers_of_columns = column[counts].astype(np.int32)
    shape = (count, free + len(edges))
    return csr_array((value[counts], numbers_of_columns, ends_of_rows), shape)


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
