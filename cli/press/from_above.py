"""The simulated hand of ``palpate servo``, which presses from above."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.body.soft_body import SoftBody
from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.rest.prop import WORLD
from ...simulated.hand.options import SimulatedOptions

HAND_FORCE = 1.5
"""Largest force of the simulated hand, N: half of its device's."""


def press_from_above(
    body: SoftBody, young_modulus: float, placement: Pose = WORLD, tool: Tool | None = None
) -> SimulatedOptions:
    """Simulated hand that presses the body, placed there, at its highest place, against the normal,
    with a tool or a point.

    It goes in by a tenth of the body's height or until it takes `HAND_FORCE`, whichever is less.
    """
    mesh = body.mesh
    extents = np.ptp(mesh.nodes, axis=0)
    highest, at, normal = highest_place(body)
    blocks = body.contact_blocks[mesh.surface_local_triangles[highest]]
    stiffness = young_modulus * float(normal @ blocks.mean(axis=0) @ normal)
    depth = min(0.1 * float(extents[2]), HAND_FORCE / stiffness)
    hand = SimulatedOptions()
    # The hand's target is deeper than the device's: its spring yields to the body's force.
    reach = depth * (1.0 + stiffness / hand.hand_stiffness)
    height = 0.2 * float(extents.max())
    at, normal = placement.to_world(at), placement.rotation @ normal
    if tool is not None:
        at = at + (tool.radius - float((tool.core @ normal).min())) * normal
    return SimulatedOptions(
        rest=vector(at + height * normal),
        at=vector(at),
        by=vector(-reach * normal),
        # At most half a metre per second for any size of body.
        approach=max(0.5, 4.0 * height),
        period=max(2.0, 8.0 * reach),
    )


def highest_place(body: SoftBody) -> tuple[int, NDArray[np.float64], NDArray[np.float64]]:
    """Surface triangle to press from above: its index, its centre (m) and its normal."""
    mesh = body.mesh
    corners = mesh.nodes[mesh.surface_triangles]
    centres = corners.mean(axis=1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    pinned = np.isin(mesh.surface_triangles, body.fixed).any(axis=1)
    extents = np.ptp(mesh.nodes, axis=0)
    # Free upward places come before steep ones, those before pinned ones; of equally high places,
    # such as a flat top, the middle.
    fit = ~pinned & (normals[:, 2] > 0.7)
    candidates = next(choice for choice in (fit, ~pinned, ~fit) if choice.any())
    high = candidates & (centres[:, 2] >= centres[candidates, 2].max() - 0.01 * extents[2])
    off_centre = np.linalg.norm((centres - centres[high].mean(axis=0))[:, :2], axis=1)
    highest = int(np.where(high, off_centre, np.inf).argmin())
    return highest, centres[highest], normals[highest]


def vector(values: NDArray[np.float64]) -> tuple[float, float, float]:
    """Three numbers."""
    return (float(values[0]), float(values[1]), float(values[2]))
