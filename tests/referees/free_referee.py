"""Referee of a free body: scikit-fem's stiffness and masses, the rigid motion kept out by force."""

from __future__ import annotations

import numpy as np
import skfem
from numpy.typing import NDArray
from scipy.sparse import bmat
from scipy.sparse.linalg import splu
from skfem.models.elasticity import lame_parameters, linear_elasticity

from palpate.core.mesh.tet_mesh import TetMesh


def rigid_motions(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Displacements of ``points`` (k, 3) per unit of each motion about the origin, (3k, 6)."""
    turns = [np.cross(axis, points) for axis in np.eye(3)]
    shifts = [np.tile(axis, (len(points), 1)) for axis in np.eye(3)]
    return np.stack([motion.ravel() for motion in (*shifts, *turns)], axis=1)


class FreeReferee:
    """A free body at unit modulus whose nodes weigh what falls to them of its volume."""

    def __init__(self, mesh: TetMesh, poisson_ratio: float) -> None:
        tets = skfem.MeshTet(mesh.nodes.T.copy(), mesh.tets.T.copy(), sort_t=False)
        vectors = skfem.Basis(tets, skfem.ElementVector(skfem.ElementTetP1()), intorder=1)
        scalars = skfem.Basis(tets, skfem.ElementTetP1(), intorder=1)
        stiffness = linear_elasticity(*lame_parameters(1.0, poisson_ratio)).assemble(vectors)
        order = vectors.nodal_dofs.T.ravel()
        volumes = skfem.LinearForm(lambda v, _: v).assemble(scalars)[scalars.nodal_dofs[0]]
        self.motions = rigid_motions(mesh.nodes)
        self.inertia = np.repeat(volumes, 3)[:, None] * self.motions
        whole = bmat([[stiffness[order][:, order], self.inertia], [self.inertia.T, None]])
        self._factor = splu(whole.tocsc())

    def displacements(self, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of all nodes (N, 3) under ``forces`` (N, 3); inertia takes what does not balance."""
        moved = self._factor.solve(np.concatenate([forces.ravel(), np.zeros(6)]))
        return moved[: forces.size].reshape(-1, 3)
