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
