"""A rigid tool on a soft body: its contact points there, its pose, and the forces between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ..near_field.compliance_beneath import NearCorrection
from ..near_field.contact_points import ContactPoints
from .tool_law import along_normals
from .tools import Pose, Tool

# Eigenvalues of the points' compliance below this share of the largest are rounding.
SINGULAR = 1e-12


@dataclass(frozen=True, eq=False)
class Load:
    """Forces on nodes of a body, such as another finger's.

    ``nodes`` (k,) of the mesh, ``forces`` (k, 3) in newton.
    """

    nodes: NDArray[np.int64]
    forces: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ToolTouch:
    """A tool on a body.

    Attributes
    ----------
    body, tool : which.
    surface : all contact points of the body for this tool.
    correction : what their compliance is besides the mesh's; None for the mesh's alone.
    pose : where the tool is; behind the pose asked for where that was farther than it may go.
    young_modulus : pascal.
    points : int64 (p,), numbers of the contact points that are pressed.
    forces : float64 (p, 3), on the body, newton.
    pushes : float64 (p,), their part along the tool's normal, all > 0.
    normals : float64 (p, 3), outward from the tool, where the points have gone to.
    displacements : float64 (p, 3), of the points, metres.
    compliance : float64 (3p, 3p), of the points, m/N.
    anchors : float64 (p, 3), where on the tool each point sticks, in the tool's coordinates.
    friction : coefficient of friction.
    free : whether the tool has been outside since it was set down; until then it feels nothing.
    exact : whether the equilibrium was found within the bounds on the work.
    """

    body: SoftBody
    tool: Tool
    surface: ContactPoints
    correction: NearCorrection | None
    pose: Pose
    young_modulus: float
    points: NDArray[np.int64]
    forces: NDArray[np.float64]
    pushes: NDArray[np.float64]
    normals: NDArray[np.float64]
    displacements: NDArray[np.float64]
    compliance: NDArray[np.float64]
    anchors: NDArray[np.float64]
    friction: float = 0.0
    free: bool = True
    exact: bool = True

    @property
    def touching(self) -> bool:
        """Whether any point is pressed."""
        return bool(len(self.points))

    @property
    def places(self) -> NDArray[np.float64]:
        """Rest places of the pressed points, (p, 3), metres."""
        return self.surface.positions[self.points]

    @property
    def pressures(self) -> NDArray[np.float64]:
        """Push per share of the surface, (p,), pascal."""
        pressures: NDArray[np.float64] = self.pushes / self.surface.areas[self.points]
        return pressures

    @property
    def force(self) -> NDArray[np.float64]:
        """Force that the tool feels, (3,), newton."""
        # Nothing is 0, not -0.
        force: NDArray[np.float64] = 0.0 - self.forces.sum(axis=0)
        return force

    @property
    def torque(self) -> NDArray[np.float64]:
        """Torque that the tool feels about its reference point, (3,), newton metres."""
        arms = self.places + self.displacements - self.pose.position
        torque: NDArray[np.float64] = 0.0 - np.cross(arms, self.forces).sum(axis=0)
        return torque

    @property
    def energy(self) -> float:
        """Elastic energy that the points' own forces hold in the body, joule."""
        forces = self.forces.reshape(-1)
        return float(0.5 * forces @ self.compliance @ forces)

    @cached_property
    def stiffness(self) -> NDArray[np.float64]:
        """How the force resists a small move of the tool while the pressed points and their normals
        stay, (3, 3), N/m, symmetric, positive semidefinite.
        """
        if not self.touching:
            return np.zeros((3, 3))
        matrix = along_normals(self.compliance, self.normals)
        # More points than the mesh has freedom beneath them make the matrix singular.
        stiffness: NDArray[np.float64] = (
            self.normals.T @ np.linalg.pinv(matrix, rcond=SINGULAR, hermitian=True) @ self.normals
        )
        return 0.5 * (stiffness + stiffness.T)

    @cached_property
    def load(self) -> Load:
        """The forces on the nodes of the mesh, repeats summed; what (15) deforms the body by."""
        corners = self.body.mesh.surface_triangles[self.surface.triangles[self.points]]
        shares = self.surface.alphas[self.points][:, :, None] * self.forces[:, None]
        nodes, place = np.unique(corners, return_inverse=True)
        forces = np.zeros((len(nodes), 3))
        np.add.at(forces, place.reshape(-1), shares.reshape(-1, 3))
        carrying = forces.any(axis=1)
        return Load(nodes[carrying], forces[carrying])

    @property
    def nodes(self) -> NDArray[np.int64]:
        """Nodes of the mesh that carry force, (k,)."""
        return self.load.nodes

    @property
    def nodal_forces(self) -> NDArray[np.float64]:
        """Forces on these nodes, (k, 3), newton."""
        return self.load.forces
