"""Bodies too large to bake on the way: what is linear is solved for when it is asked."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.solid.free_solid import FreeSolid


@dataclass(frozen=True, eq=False)
class SolvedBody(SoftBody):
    """A body whose compliance knows its free surface only."""

    @classmethod
    def of(
        cls, mesh: TetMesh, fixed: NDArray[np.int64], poisson_ratio: float, young_modulus: float
    ) -> SolvedBody:
        """With linear tetrahedra."""
        nodes = np.setdiff1d(mesh.surface_nodes, fixed)
        unknown = DenseCompliance(nodes, np.empty((len(nodes), 3, 0)))
        return cls(mesh, fixed, poisson_ratio, unknown, young_modulus)

    @cached_property
    def solid(self) -> FreeSolid:
        """Whose factor of the stiffness solves."""
        return FreeSolid.of(self)

    def deform(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
    ) -> NDArray[np.float64]:
        """As :meth:`SoftBody.deform`."""
        forces = self.solid.on_free_nodes(nodes, nodal_forces / self.modulus(young_modulus))
        moved: NDArray[np.float64] = self.solid.linear(forces)[self.solid.surface]
        return moved


def cut_in_eight(mesh: TetMesh, fixed: NDArray[np.int64]) -> tuple[TetMesh, NDArray[np.int64]]:
    """Every tetrahedron cut at the middles of its edges; middles between pins are pinned."""
    ends = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
    edges, which = np.unique(
        np.sort(mesh.tets[:, ends].reshape(-1, 2), axis=1), axis=0, return_inverse=True
    )
    count = len(mesh.nodes)
    all_nodes = np.hstack([mesh.tets, count + which.reshape(-1, 6)])
    # Four at the corners, four around the diagonal from the first edge's middle to the last's.
    pieces = [[0, 4, 5, 6], [4, 1, 7, 8], [5, 7, 2, 9], [6, 8, 9, 3]]
    pieces += [[4, around, following, 9] for around, following in ((5, 6), (6, 8), (8, 7), (7, 5))]
    tets = all_nodes[:, np.array(pieces)].reshape(-1, 4)
    nodes = np.concatenate([mesh.nodes, mesh.nodes[edges].mean(axis=1)])
    corners = nodes[tets]
    sides = corners[:, 1:] - corners[:, :1]
    turned = np.linalg.det(sides) < 0
    tets[turned] = tets[turned][:, [0, 1, 3, 2]]
    between_pins = np.isin(edges, fixed).all(axis=1)
    pinned = np.union1d(fixed, count + np.flatnonzero(between_pins))
    return TetMesh.checked(nodes, tets), pinned
