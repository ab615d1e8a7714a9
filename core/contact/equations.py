"""Touch: the force that would cause a given displacement. Equations (9) to (14) of the paper.

:mod:`.consistent_contact` and :mod:`.several_contacts` continue them where the paper stops. This
is the readable reference; the servo computes the same natively, a thousand times a second.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

# How a contact inside a triangle is answered: its point moves by exactly the finger's displacement,
# or the three nodes share it as in the paper (11), (12).
ContactMode: TypeAlias = Literal["consistent", "paper"]
CONTACT_MODES: tuple[ContactMode, ...] = ("consistent", "paper")


@dataclass(frozen=True, eq=False)
class Touch:
    """One finger on one surface triangle.

    Attributes
    ----------
    triangle : int64 (3,), node numbers i, j, k of the tetrahedral mesh.
    alpha : float64 (3,), area coordinates of the contact point, sum 1.
    point : float64 (3,), the contact point (god object) on the rest surface, metres.
    displacement : float64 (3,), u: finger minus god object, metres.
    nodal_forces : float64 (3, 3), F_i, F_j, F_k on the body, newton.
    """

    triangle: NDArray[np.int64]
    alpha: NDArray[np.float64]
    point: NDArray[np.float64]
    displacement: NDArray[np.float64]
    nodal_forces: NDArray[np.float64]

    @property
    def force(self) -> NDArray[np.float64]:
        """Force felt by the finger, (3,), newton (14)."""
        return felt_force(self.nodal_forces)


def one_node_force(block: ArrayLike, displacement: ArrayLike) -> NDArray[np.float64]:
    """F_i = L_ii^-1 u_i (9). ``block`` (3, 3) is L_ii, ``displacement`` (3,)."""
    force: NDArray[np.float64] = np.linalg.solve(np.asarray(block), np.asarray(displacement))
    return force


def two_node_forces(
    blocks: ArrayLike, displacement_i: ArrayLike, displacement_j: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forces on two nodes held at given displacements at once (10).

    ``blocks`` (2, 2, 3, 3) is [[L_ii, L_ij], [L_ji, L_jj]]. Returns F_i and F_j, (3,) each.
    """
    coupled = np.asarray(blocks, dtype=np.float64).transpose(0, 2, 1, 3).reshape(6, 6)
    forces = np.linalg.solve(coupled, np.concatenate([displacement_i, displacement_j]))
    return forces[:3], forces[3:]


def area_coordinates(point: ArrayLike, corners: ArrayLike) -> NDArray[np.float64]:
    """Area coordinates (3,) of a ``point`` (3,) in the triangle of ``corners`` (3, 3) (13)."""
    i, j, k = np.asarray(corners, dtype=np.float64)
    f = np.asarray(point, dtype=np.float64)
    normal = np.cross(j - i, k - i)
    parts = np.array(
        [
            np.cross(j - f, k - f) @ normal,
            np.cross(k - f, i - f) @ normal,
            np.cross(i - f, j - f) @ normal,
        ]
    )
    coordinates: NDArray[np.float64] = parts / (normal @ normal)
    return coordinates


def triangle_forces(
    contact_blocks: ArrayLike, alpha: ArrayLike, displacement: ArrayLike
) -> NDArray[np.float64]:
    """Nodal forces F_a = alpha_a L_aa^-1 u of a contact inside a triangle (11), (12).

    ``contact_blocks`` (3, 3, 3) are the three L_aa^-1, ``alpha`` (3,), ``displacement`` (3,).
    Returns (3, 3), one row a node.
    """
    alone = np.asarray(contact_blocks, dtype=np.float64) @ np.asarray(displacement)
    forces: NDArray[np.float64] = np.asarray(alpha)[:, None] * alone
    return forces


def felt_force(nodal_forces: ArrayLike) -> NDArray[np.float64]:
    """Force on the finger, F_f = -(F_i + F_j + F_k) (14). ``nodal_forces`` (3, 3) -> (3,)."""
    force: NDArray[np.float64] = 0.0 - np.asarray(nodal_forces, dtype=np.float64).sum(axis=0)
    return force
