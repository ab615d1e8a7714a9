"""Traction of a pressed surface at any of its places: contact pressure and its direction.

Contact points stand for their shares of the surface, and their pushes are spread over them by a
kernel whose integral is one (Wendland's C2, piecewise polynomial, positive and without overshoot;
Advances in Computational Mathematics 4, 1995). So the pressure's integral over the surface is the
force, as exactly as the places sample it, and away from a patch it is exactly zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .tool.pose import Pose
from .tool.tools import Tool
from .touches import ToolTouch

Array = NDArray[np.float64]

# Radius of the kernel over the root of a point's share: neighbours on a lattice overlap, so that an
# even pressure is even between them, to 4 %.
REACH = 2.0


@dataclass(frozen=True, eq=False)
class PressedPatch:
    """Contact points that a tool presses, where they are now.

    Attributes
    ----------
    places : float64 (p, 3), metres.
    normals : float64 (p, 3), outward unit normals of the body there.
    pushes : float64 (p,), forces along them, newton.
    areas : float64 (p,), their shares of the surface, square metres.
    """

    places: Array
    normals: Array
    pushes: Array
    areas: Array

    @classmethod
    def of_touch(cls, touch: ToolTouch) -> PressedPatch:
        """Of a touch without a clock."""
        return cls(touch.places + touch.displacements, -touch.normals, touch.pushes, touch.areas)

    @classmethod
    def of_finger(
        cls, tool: Tool, pose: Pose, places: Array, forces: Array, pressures: Array
    ) -> PressedPatch:
        """Of a tool at a pose that presses ``places`` (p, 3), metres, with ``forces`` (p, 3) on the
        body, newton, at ``pressures`` (p,), pascal.
        """
        pressed = pressures > 0.0
        inward = tool.distance(pose.to_tool(places[pressed]))[1] @ pose.rotation.T
        pushes = np.einsum("pi,pi->p", forces[pressed], inward)
        return cls(places[pressed], -inward, pushes, pushes / pressures[pressed])


def tractions(patches: Sequence[PressedPatch], places: Array) -> Array:
    """Pressure times the outward normal of what is pressed, pascal (v, 3), at places (v, 3) of the
    deformed surface, metres.
    """
    found = np.zeros_like(places)
    for patch in patches:
        if len(patch.places):
            _add(found, patch, places)
    return found


def _add(found: Array, patch: PressedPatch, places: Array) -> None:
    radii = REACH * np.sqrt(patch.areas)
    reach = float(radii.max())
    low, high = patch.places.min(axis=0) - reach, patch.places.max(axis=0) + reach
    near = np.flatnonzero(((places > low) & (places < high)).all(axis=1))
    if not len(near):
        return
    apart = cKDTree(places[near]).sparse_distance_matrix(
        cKDTree(patch.places), reach, output_type="coo_matrix"
    )
    share = apart.data / radii[apart.col]
    kernel = 7.0 / (np.pi * radii[apart.col] ** 2) * (1.0 - share) ** 4 * (4.0 * share + 1.0)
    weight = np.where(share < 1.0, kernel * patch.pushes[apart.col], 0.0)
    np.add.at(found, near[apart.row], weight[:, None] * patch.normals[apart.col])
