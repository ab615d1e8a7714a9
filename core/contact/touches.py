"""Touches: settled forces of points and tools on a body."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from .tool.pose import Pose
from .tool.tools import Tool

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PointTouch:
    """Touch of a point on a surface triangle.

    Attributes
    ----------
    triangle : int64 (3,), node numbers i, j, k of the tetrahedral mesh.
    alpha : float64 (3,), area coordinates of the contact point, sum 1.
    point : float64 (3,), the contact point (god object) on the rest surface, metres.
    displacement : float64 (3,), u: finger minus god object, metres.
    force : float64 (3,), on the finger, newton (14).
    nodal_forces : float64 (3, 3), F_i, F_j, F_k on the body by the linear force law, newton,
        for drawing.
    """

    triangle: NDArray[np.int64]
    alpha: Array
    point: Array
    displacement: Array
    force: Array
    nodal_forces: Array

    area = 0.0
    largest_pressure = 0.0

    def times(self, share: float) -> PointTouch:
        """With so much of its force at the same place."""
        return replace(self, force=share * self.force, nodal_forces=share * self.nodal_forces)

    @property
    def nodes(self) -> NDArray[np.int64]:
        """Nodes of the mesh that carry force, (3,)."""
        return self.triangle


@dataclass(frozen=True, eq=False)
class ToolTouch:
    """Touch of a rigid tool that presses p contact points.

    Attributes
    ----------
    body : that it touches, with its imprint.
    tool, pose : of the touch.
    force : float64 (3,), on the tool, newton.
    torque : float64 (3,), on the tool about its reference point, newton metres.
    stiffness : float64 (3, 3), tangent of the force for a fixed contact patch, N/m, symmetric,
        positive semidefinite.
    points : int64 (p,), numbers of the pressed contact points, ascending.
    places : float64 (p, 3), of these at rest, metres.
    displacements : float64 (p, 3), metres.
    normals : float64 (p, 3), outward from the tool at the displaced points.
    forces : float64 (p, 3), on the body there, newton.
    pushes : float64 (p,), normal components of the forces, all > 0.
    areas : float64 (p,), the points' shares of the surface, square metres.
    nodes : int64 (k,), nodes of the mesh that carry force.
    nodal_forces : float64 (k, 3), forces on these, newton.
    """

    body: SoftBody
    tool: Tool
    pose: Pose
    force: Array
    torque: Array
    stiffness: Array
    points: NDArray[np.int64]
    places: Array
    displacements: Array
    normals: Array
    forces: Array
    pushes: Array
    areas: Array
    nodes: NDArray[np.int64]
    nodal_forces: Array

    def times(self, share: float) -> ToolTouch:
        """With so much of all its forces at the same pose, and as much stiffer."""
        return replace(
            self,
            force=share * self.force,
            torque=share * self.torque,
            stiffness=share * self.stiffness,
            forces=share * self.forces,
            pushes=share * self.pushes,
            nodal_forces=share * self.nodal_forces,
        )

    @property
    def touching(self) -> bool:
        """Whether any point is pressed."""
        return bool(len(self.points))

    @property
    def pressures(self) -> Array:
        """Normal pressure at the pressed points, (p,), pascal."""
        pressures: Array = self.pushes / self.areas
        return pressures

    @property
    def largest_pressure(self) -> float:
        """Pascal; 0 without any contact."""
        return float(self.pressures.max(initial=0.0))

    @property
    def area(self) -> float:
        """Contact area, square metres."""
        return float(self.areas.sum())

    @property
    def energy(self) -> float:
        """Half the work of its forces on the places they move, joule: of all tools on a body
        together, the elastic energy in it.
        """
        return 0.5 * float((self.forces * self.displacements).sum())


Touch = PointTouch | ToolTouch


def contact_displacement(body: SoftBody, touch: PointTouch, displacements: Array) -> Array:
    """Displacement (3,) of the touched point, from those of the free surface nodes (n, 3)."""
    free, corner = body.free_index(touch.triangle), np.arange(3)
    held = free >= 0
    moved: Array = touch.alpha[corner[held]] @ displacements[free[held]]
    return moved
