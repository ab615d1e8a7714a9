"""The same body with finer tetrahedra: its shape stays, every tetrahedron becomes eight."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh, signed_volumes
from palpate.core.shape.lattice.tet_samples import EDGES, EIGHT


def refined(mesh: TetMesh, fixed: NDArray[np.int64]) -> tuple[TetMesh, NDArray[np.int64]]:
    """The mesh with all edges halved, and its pins: also the middles between two pinned nodes.

    Old nodes keep their numbers.
    """
    ends = np.sort(mesh.tets[:, EDGES].reshape(-1, 2), axis=1)
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    nodes = np.concatenate([mesh.nodes, mesh.nodes[edges].mean(axis=1)])
    middles = len(mesh.nodes) + number.reshape(-1, len(EDGES))
    tets = np.concatenate([mesh.tets, middles], axis=1)[:, EIGHT].reshape(-1, 4)
    turned = signed_volumes(nodes, tets) < 0
    tets[turned, 2], tets[turned, 3] = tets[turned, 3].copy(), tets[turned, 2].copy()
    between = len(mesh.nodes) + np.flatnonzero(np.isin(edges, fixed).all(axis=1))
    return TetMesh.checked(nodes, tets), np.union1d(fixed, between)


def coarse_ball(radius: float, cells: int) -> tuple[TetMesh, NDArray[np.int64]]:
    """A cube of cells drawn out to a ball about the origin, held by what was the cube's bottom."""
    mesh, fixed = paper_cube(2.0, cells)
    corner = mesh.nodes - 1.0
    reach = np.abs(corner).max(axis=1)
    length = np.linalg.norm(corner, axis=1)
    scale = np.divide(reach, length, out=np.zeros_like(length), where=length > 0)
    return TetMesh.checked(radius * corner * scale[:, None], mesh.tets), fixed
