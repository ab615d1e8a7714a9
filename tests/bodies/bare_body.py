"""Bodies of which only the tetrahedra count: nothing is baked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh


def bare_body(
    mesh: TetMesh,
    fixed: NDArray[np.int64],
    poisson_ratio: float = 0.3,
    formulation: str = "linear",
    young_scale: NDArray[np.float64] | None = None,
) -> SoftBody:
    """A body of 1 Pa with an empty compliance."""
    nodes = np.setdiff1d(mesh.surface_nodes, fixed)
    none = DenseCompliance(nodes, np.empty((len(nodes), 3, 0)))
    return SoftBody(mesh, fixed, poisson_ratio, none, 1.0, formulation, young_scale)


def beam_mesh(cells: int, length: float, axis: int) -> tuple[TetMesh, NDArray[np.int64]]:
    """A beam of 1 m square and ``length`` metres along ``axis``; the nodes of its end at zero."""
    cube, _ = paper_cube(1.0, cells)
    mesh = TetMesh.checked(cube.nodes * np.where(np.arange(3) == axis, length, 1.0), cube.tets)
    return mesh, np.flatnonzero(mesh.nodes[:, axis] == 0.0)
