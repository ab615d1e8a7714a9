"""Shape of a body's surface: normals, areas, edges and angles of its triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from ...mesh.tet_mesh import TetMesh

# Faces that meet at a larger angle make a crease: the normals of one do not turn towards the other.
CREASE_ANGLE = np.radians(40.0)


def smooth_corner_normals(mesh: TetMesh) -> NDArray[np.float64]:
    """Outward unit normals at the corners of all surface triangles, (S, 3, 3).

    At each corner the mean of the faces around that node, weighted by their angles there (Thürmer
    and Wüthrich 1998), without those beyond a crease.
    """
    triangles, faces = mesh.surface_local_triangles, face_normals(mesh)
    angles = corner_angles(mesh).reshape(-1)
    count = triangles.size
    at_node = coo_array(
        (np.ones(count), (np.arange(count), triangles.reshape(-1))),
        shape=(count, len(mesh.surface_nodes)),
    ).tocsr()
    meeting = (at_node @ at_node.T).tocoo()
    own, other = meeting.row, meeting.col
    smooth = np.einsum("mx,mx->m", faces[own // 3], faces[other // 3]) > np.cos(CREASE_ANGLE)
    own, other = own[smooth], other[smooth]
    mean = coo_array((angles[other], (own, other // 3)), shape=(count, len(triangles))).tocsr()
    return unit((mean @ faces).reshape(-1, 3, 3))


def on_curved_triangles(
    corners: NDArray[np.float64], normals: NDArray[np.float64], alphas: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Places (p, 3) of area coordinates ``alphas`` (p, 3) on curved triangles with these corners
    and unit normals there, both (p, 3, 3), metres.

    Half of the mean way to the corners' tangent planes is added to a place of the flat triangle,
    which is exact to second order on any smooth surface: the whole of it goes twice too far. (The
    planes are those of Phong tessellation, Boubekeur and Alexa 2008, where the share is free.)
    """
    flat = np.einsum("pc,pcx->px", alphas, corners)
    short = np.einsum("pcx,pcx->pc", corners - flat[:, None], normals)
    curved: NDArray[np.float64] = flat + 0.5 * np.einsum("pc,pcx->px", alphas * short, normals)
    return curved


def node_normals(mesh: TetMesh) -> NDArray[np.float64]:
    """Angle-weighted mean normals of all faces around each surface node, (s, 3)."""
    weighted = corner_angles(mesh)[:, :, None] * face_normals(mesh)[:, None, :]
    mean = np.zeros((len(mesh.surface_nodes), 3))
    np.add.at(mean, mesh.surface_local_triangles.reshape(-1), weighted.reshape(-1, 3))
    return unit(mean)


def face_vectors(mesh: TetMesh) -> NDArray[np.float64]:
    """Outward normals of the surface's triangles (S, 3), twice their areas long."""
    i, j, k = (mesh.nodes[mesh.surface_triangles[:, corner]] for corner in range(3))
    vectors: NDArray[np.float64] = np.cross(j - i, k - i)
    return vectors


def face_normals(mesh: TetMesh) -> NDArray[np.float64]:
    """Outward unit normals of the surface's triangles, (S, 3)."""
    return unit(face_vectors(mesh))


def face_areas(mesh: TetMesh) -> NDArray[np.float64]:
    """Areas of the surface's triangles, (S,), square metres."""
    areas: NDArray[np.float64] = 0.5 * np.linalg.norm(face_vectors(mesh), axis=1)
    return areas


def node_areas(mesh: TetMesh) -> NDArray[np.float64]:
    """Share of the surface of each of its nodes, (s,), square metres."""
    corners = mesh.surface_local_triangles.ravel()
    areas = np.bincount(corners, np.repeat(face_areas(mesh) / 3.0, 3), len(mesh.surface_nodes))
    return areas.astype(np.float64)


def surface_area(mesh: TetMesh) -> float:
    """Surface area of a body, square metres."""
    return float(face_areas(mesh).sum())


def edge_lengths(mesh: TetMesh) -> NDArray[np.float64]:
    """Length (S, 3) of the edges from each corner to the next."""
    corners = mesh.nodes[mesh.surface_triangles]
    lengths: NDArray[np.float64] = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    return lengths


def corner_angles(mesh: TetMesh) -> NDArray[np.float64]:
    """Angle (S, 3) of each triangle at each corner, radians."""
    corners = mesh.nodes[mesh.surface_triangles]
    ahead = unit(np.roll(corners, -1, axis=1) - corners)
    back = unit(np.roll(corners, 1, axis=1) - corners)
    angles: NDArray[np.float64] = np.arccos(
        np.clip(np.einsum("tcx,tcx->tc", ahead, back), -1.0, 1.0)
    )
    return angles


def unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors (..., 3) of length 1; those of no length stay so."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    shortened: NDArray[np.float64] = np.divide(
        vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0
    )
    return shortened
