"""Solid angle of a body around places on its surface: half a sphere where it is flat."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...mesh.tet_mesh import TetMesh

FLAT = 2.0 * np.pi

# A place with more than the second of these shares of a half-space around it is on a round surface,
# with less than the first on an edge.
ROUND = (0.55, 0.75)

# The exponent that lets a cube's edge and tip give way as in finite elements.
SHARPENING = 1.3


def edge_shares(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Whether a place with such a solid angle is on a sharp edge (1) or a round surface (0), (p,).

    A surface that is only made of flat triangles is not sharp.
    """
    low, high = ROUND
    shares: NDArray[np.float64] = np.clip((high - angles / FLAT) / (high - low), 0.0, 1.0)
    return shares


def sharpness(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compliance on an edge or a tip relative to a half-space, (p,), 1 and more.

    The power of what there is around it to hold it that a cube's edge and tip come out as finite
    elements have them, 2.5 and 6.
    """
    more = np.maximum((angles / FLAT) ** -SHARPENING - 1.0, 0.0)
    sharp: NDArray[np.float64] = 1.0 + edge_shares(angles) * more
    return sharp


def solid_angles(
    mesh: TetMesh, triangles: NDArray[np.int64], alphas: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Solid angle (p,) of the body, in steradian, seen from points on its surface.

    ``triangles`` (p,) are numbers of surface triangles, ``alphas`` (p, 3) area coordinates, exactly
    1 at nodes and exactly 0 at a corner across from an edge. 2 pi inside a triangle, pi on an edge
    like a cube's, half of that at its tip.
    """
    found = np.full(len(triangles), FLAT)
    rows, corners = np.nonzero(alphas == 1.0)
    nodes = mesh.surface_local_triangles[triangles[rows], corners]
    found[rows] = node_angles(mesh)[nodes]
    rows, corners = np.nonzero((alphas == 0.0) & ((alphas == 0.0).sum(axis=1) == 1)[:, None])
    found[rows] = 2.0 * _along_edges(mesh)[triangles[rows], (corners + 1) % 3]
    return found


def node_angles(mesh: TetMesh) -> NDArray[np.float64]:
    """Solid angle of the body at each surface node, (s,), steradian: the sum over the tetrahedra.

    Each by A. Van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983), 125.
    """
    total = np.zeros(len(mesh.nodes))
    for corner in range(4):
        at = mesh.tets[:, corner]
        a, b, c = (
            mesh.nodes[mesh.tets[:, (corner + other) % 4]] - mesh.nodes[at] for other in (1, 2, 3)
        )
        i, j, k = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        volume = np.abs(np.einsum("mx,mx->m", a, np.cross(b, c)))
        ab, bc, ca = (np.einsum("mx,mx->m", *pair) for pair in ((a, b), (b, c), (c, a)))
        angle = 2.0 * np.arctan2(volume, i * j * k + ab * k + bc * i + ca * j)
        total += np.bincount(at, angle, len(total))
    around: NDArray[np.float64] = total[mesh.surface_nodes]
    return around


def _along_edges(mesh: TetMesh) -> NDArray[np.float64]:
    """Angle (S, 3) within the body at the edge from each corner of a triangle to the next, radians.

    Where an edge has more or fewer than two triangles, pi.
    """
    triangles = mesh.surface_triangles
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    _, edge, count = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True, return_counts=True)
    edge = edge.reshape(-1)
    order = np.argsort(edge, kind="stable")
    order = order[count[edge[order]] == 2].reshape(-1, 2)
    angles = np.full(triangles.size, np.pi)
    angles[order[:, 0]] = angles[order[:, 1]] = _between(mesh, order // 3)
    return angles.reshape(-1, 3)


def _between(mesh: TetMesh, pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Angle (e,) within the body between pairs (e, 2) of triangles that share an edge."""
    corners = mesh.nodes[mesh.surface_triangles[pairs]]
    normals = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    bend = np.arccos(np.clip(np.einsum("ex,ex->e", normals[:, 0], normals[:, 1]), -1.0, 1.0))
    middles = corners.mean(axis=2)
    rises = np.einsum("ex,ex->e", middles[:, 1] - middles[:, 0], normals[:, 0]) > 0
    angle: NDArray[np.float64] = np.pi + np.where(rises, bend, -bend)
    return angle
