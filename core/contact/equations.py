"""Touch: the force that would cause a given displacement. Equations (9) to (14) of the paper.

Documentation, and what tests compare with: the native engine (:mod:`.press`) computes the same.

Two things continue them where the paper stops. Its weights (11), (12) take each node of a triangle
as if it were pulled alone, so that inside a triangle the contact point stays short of the finger.
In the mode ``consistent`` the contact point is what is moved: it is the mean of its three nodes,
weighted by the area coordinates a, and so is its force spread over them. Among all forces on the
three nodes that move the contact point by exactly u these are the smallest in the sense of elastic
energy::

    C = sum_ab a_a a_b L_ab        F_a = a_a C^-1 u

At a node this is (9); on an edge the third node has no part, so that the force is continuous over
edges. Several contacts p, q feel each other by C_pq = sum_ab a_pa a_qb L_ab, on nodes (10).
``docs/contact.md`` has the rest: fingers that may only push, and fingers on one place.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

# How a contact inside a triangle is answered: its point moves by exactly the finger's displacement,
# or the three nodes share it as in the paper (11), (12).
ContactMode: TypeAlias = Literal["consistent", "paper"]
CONTACT_MODES: tuple[ContactMode, ...] = ("consistent", "paper")


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


def contact_compliance(blocks: ArrayLike, alpha: ArrayLike) -> NDArray[np.float64]:
    """C (3, 3): how far the contact point moves per newton on it.

    ``blocks`` (3, 3, 3, 3) are L_ab of the triangle's nodes, ``alpha`` (3,) area coordinates.
    """
    weights = np.asarray(alpha, dtype=np.float64)
    local = np.asarray(blocks, dtype=np.float64)
    compliance: NDArray[np.float64] = np.einsum("a,abij,b->ij", weights, local, weights)
    return compliance


def consistent_forces(
    blocks: ArrayLike, alpha: ArrayLike, displacement: ArrayLike
) -> NDArray[np.float64]:
    """Nodal forces F_a = a_a C^-1 u, (3, 3), one row a node.

    ``blocks`` (3, 3, 3, 3), ``alpha`` (3,), ``displacement`` u (3,); newton if the blocks are of
    the body's real modulus, of one of 1 Pa otherwise.
    """
    force = np.linalg.solve(contact_compliance(blocks, alpha), np.asarray(displacement))
    spread: NDArray[np.float64] = np.asarray(alpha, dtype=np.float64)[:, None] * force
    return spread


def coupled_compliance(blocks: ArrayLike, alphas: ArrayLike) -> NDArray[np.float64]:
    """C_pq = sum_ab a_pa a_qb L_ab, (m, m, 3, 3), of m contact points.

    ``blocks`` (m, 3, m, 3, 3, 3) holds L between node a of contact p and node b of contact q at
    [p, a, q, b], ``alphas`` (m, 3) the area coordinates.
    """
    weights = np.asarray(alphas, dtype=np.float64)
    between = np.asarray(blocks, dtype=np.float64)
    compliance: NDArray[np.float64] = np.einsum("pa,paqbij,qb->pqij", weights, between, weights)
    return compliance
