"""Map of a body's softness to a finger, all over its surface.

At each node: the stiffness against a small round pad, from the diagonal blocks of the compliance,
k = E / (n . C n). C = L_aa of a node alone depends on the mesh: a node of small triangles gives way
more. With the near field (:mod:`..contact.near_field`) C is that of a pad of a given size under
even pressure, for any mesh.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..contact.near_field.compliance_beneath import IN_CONTACT, near_correction
from ..contact.near_field.contact_points import ContactPoints
from ..contact.near_field.half_space import OWN_CELL
from ..contact.near_field.surface_shape import node_normals
from ..errors import PalpateError

# Pad of a lightly resting fingertip.
FINGER_RADIUS = 5e-3

# Mean displacement under an even pressure on a disc, times sqrt(area) pi / (1 - nu^2) per newton at
# 1 Pa: 16 / (3 sqrt(pi)) (Johnson, Contact Mechanics, section 3.4). The near field has OWN_CELL,
# and of that IN_CONTACT.
DISC_MEAN = 16.0 / (3.0 * np.sqrt(np.pi))

# Shares of the nodes outside the colours' range at either end.
CLIPPED = 0.02


@dataclass(frozen=True, eq=False)
class SoftnessMap:
    """Stiffness against a push along the normal.

    Attributes
    ----------
    stiffness : float64 (s,), N/m for every node of ``mesh.surface_nodes``; where a body is pinned,
        that of its firmest free place.
    pad_radius : metres; 0 for the node itself, as the mesh has it.
    """

    stiffness: NDArray[np.float64]
    pad_radius: float

    @property
    def span(self) -> tuple[float, float]:
        """Lowest and highest stiffness of the colours, N/m; a few nodes lie beyond."""
        low, high = np.quantile(self.stiffness, [CLIPPED, 1.0 - CLIPPED])
        return float(low), float(high)

    def shares(self) -> NDArray[np.float64]:
        """Each node's position between the ends of :attr:`span`, logarithmic, 0 to 1."""
        low, high = self.span
        if high <= low * (1.0 + 1e-9):
            return np.full(len(self.stiffness), 0.5)
        shares: NDArray[np.float64] = np.log(self.stiffness / low) / np.log(high / low)
        return np.clip(shares, 0.0, 1.0)


def softness_map(
    body: SoftBody, *, pad_radius: float = FINGER_RADIUS, young_modulus: float | None = None
) -> SoftnessMap:
    """Stiffness at every surface node.

    Parameters
    ----------
    pad_radius : of a round pad, metres; 0 for the bare node.
    young_modulus : pascal; the body's own unless given.

    Raises
    ------
    PalpateError
        A radius that is negative or not finite; a Young's modulus that is not positive.
    """
    modulus = body.modulus(young_modulus)
    if not (np.isfinite(pad_radius) and pad_radius >= 0):
        raise PalpateError(
            "softness map: pad radius is {pad_radius}; give zero or more metres",
            pad_radius=pad_radius,
        )
    normals = node_normals(body.mesh)
    blocks = np.linalg.inv(body.contact_blocks)
    if pad_radius > 0:
        blocks = blocks + _of_pads(body, normals, pad_radius)
    along = np.einsum("sx,sxy,sy->s", normals, blocks, normals)
    stiffness = modulus / along
    free = body.free_index(body.mesh.surface_nodes) >= 0
    stiffness[~free] = stiffness[free].max()
    return SoftnessMap(stiffness, pad_radius)


def _of_pads(body: SoftBody, normals: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """Addition of a pad's size to the block of each node, (s, 3, 3), m / N at 1 Pa."""
    mesh = body.mesh
    count = len(mesh.surface_nodes)
    triangle, corner = np.divmod(np.unique(mesh.surface_local_triangles, return_index=True)[1], 3)
    pads = ContactPoints(
        positions=mesh.nodes[mesh.surface_nodes],
        normals=normals,
        triangles=triangle,
        alphas=np.eye(3)[corner],
        areas=np.full(count, np.pi * radius**2 * (IN_CONTACT * OWN_CELL / DISC_MEAN) ** 2),
    )
    return near_correction(body, pads).own
