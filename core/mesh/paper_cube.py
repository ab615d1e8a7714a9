"""Cube of the paper's Table 1: cells of five tetrahedra each, bottom fixed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .tet_mesh import TetMesh

# Corners of a cell are numbered x + 2 y + 4 z. One tetrahedron in the middle, four at corners;
# neighbouring cells take the mirror image so that the diagonals of shared faces meet.
FIVE_TETS = np.array([[0, 3, 6, 5], [0, 1, 3, 5], [0, 3, 2, 6], [0, 5, 6, 4], [3, 5, 7, 6]])
MIRRORED_TETS = np.array([[1, 2, 4, 7], [0, 1, 2, 4], [1, 3, 2, 7], [1, 4, 5, 7], [2, 4, 7, 6]])


def paper_cube(edge: float = 0.05, cells: int = 4) -> tuple[TetMesh, NDArray[np.int64]]:
    """Cube ``[0, edge]^3`` of ``cells^3`` cells and the numbers of its fixed bottom nodes (z = 0).

    The defaults give Table 1: 125 nodes, 320 tetrahedra, 98 surface nodes, 192 surface
    triangles, 25 fixed.
    """
    steps = cells + 1
    ticks = np.linspace(0.0, edge, steps)
    z, y, x = np.meshgrid(ticks, ticks, ticks, indexing="ij")
    nodes = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    k, j, i = (index.ravel() for index in np.indices((cells, cells, cells)))
    corner = np.arange(8)
    offsets = (corner & 1) + (corner >> 1 & 1) * steps + (corner >> 2) * steps**2
    cell_corners = (i + j * steps + k * steps**2)[:, None] + offsets
    mirrored = ((i + j + k) % 2 == 1)[:, None, None]
    tets = np.where(mirrored, cell_corners[:, MIRRORED_TETS], cell_corners[:, FIVE_TETS])
    mesh = TetMesh.checked(nodes, tets.reshape(-1, 4))
    return mesh, np.flatnonzero(nodes[:, 2] == 0.0)
