"""Mass of a body, lumped to its nodes, and its rigid motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...mesh.tet_mesh import TetMesh


@dataclass(frozen=True, eq=False)
class Inertia:
    """Mass and moments of a body at a density of 1 kg/m3; multiply by the real one.

    A quarter of each tetrahedron's mass is at each of its corners.

    Attributes
    ----------
    node_volumes : float64 (N,), mass of each node over the density, m3.
    centre : float64 (3,), of mass, m.
    moments : float64 (3, 3), tensor of inertia about the centre over the density, m5.
    """

    node_volumes: NDArray[np.float64]
    centre: NDArray[np.float64]
    moments: NDArray[np.float64]

    @classmethod
    def of(cls, mesh: TetMesh) -> Inertia:
        """The inertia of a mesh.

        >>> from palpate.core.mesh.paper_cube import paper_cube
        >>> inertia = Inertia.of(paper_cube()[0])
        >>> [round(1e6 * inertia.volume, 6), *(1e3 * inertia.centre).round(6).tolist()]
        [125.0, 25.0, 25.0, 25.0]
        """
        quarters = np.repeat(mesh.tet_volumes / 4.0, 4)
        node_volumes = np.zeros(len(mesh.nodes))
        np.add.at(node_volumes, mesh.tets.ravel(), quarters)
        return cls.at(mesh.nodes, node_volumes)

    @classmethod
    def at(cls, points: NDArray[np.float64], node_volumes: NDArray[np.float64]) -> Inertia:
        """The inertia of masses at ``points`` (N, 3)."""
        centre = node_volumes @ points / node_volumes.sum()
        arms = points - centre
        spread = (node_volumes[:, None] * arms).T @ arms
        return cls(node_volumes, centre, np.trace(spread) * np.eye(3) - spread)

    @property
    def volume(self) -> float:
        """Mass over the density, m3."""
        return float(self.node_volumes.sum())

    def modes(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements of ``points`` (k, 3) per metre along and radian about each axis through
        the centre, (k, 3, 6).
        """
        x, y, z = (points - self.centre).T
        modes = np.zeros((len(points), 3, 6))
        modes[:, :, :3] = np.eye(3)
        modes[:, 1, 3], modes[:, 2, 3] = -z, y
        modes[:, 2, 4], modes[:, 0, 4] = -x, z
        modes[:, 0, 5], modes[:, 1, 5] = -y, x
        return modes

    @property
    def masses(self) -> NDArray[np.float64]:
        """Mass and moments of the six motions of :meth:`modes` over the density, (6, 6)."""
        masses = np.zeros((6, 6))
        masses[:3, :3] = self.volume * np.eye(3)
        masses[3:, 3:] = self.moments
        return masses


@dataclass(frozen=True, eq=False)
class RigidMotions:
    """Six rigid motions of a body, orthonormal by mass at a density of 1 kg/m3.

    Attributes
    ----------
    modes : float64 (3N, 6), R^: displacements of all nodes.
    loads : float64 (3N, 6), M R^: the loads of inertia against them.
    """

    modes: NDArray[np.float64]
    loads: NDArray[np.float64]

    @classmethod
    def of(cls, inertia: Inertia, points: NDArray[np.float64]) -> RigidMotions:
        """The motions of the nodes, at ``points`` (N, 3), whose inertia it is."""
        mixed = np.linalg.inv(np.linalg.cholesky(inertia.masses)).T
        modes = (inertia.modes(points) @ mixed).reshape(-1, 6)
        return cls(modes, np.repeat(inertia.node_volumes, 3)[:, None] * modes)

    @property
    def of_nodes(self) -> NDArray[np.float64]:
        """The motions node by node, (N, 3, 6)."""
        return self.modes.reshape(-1, 3, 6)

    def still(self, displacements: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (N, 3) without their rigid motion, P u."""
        shares = self.loads.T @ displacements.ravel()
        return displacements - (self.modes @ shares).reshape(-1, 3)

    def balanced(self, forces: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (N, 3) with the loads of inertia that balance them, P^T f."""
        shares = self.modes.T @ forces.ravel()
        return forces - (self.loads @ shares).reshape(-1, 3)
