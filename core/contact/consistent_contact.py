"""One contact whose point moves by exactly the finger's displacement; continues equation (9).

The paper's weights (11), (12) take each node of a triangle as if it were pulled alone, so that
inside a triangle the contact point stays short of the finger. Here the contact point is what is
moved: it is the mean of its three nodes, weighted by the area coordinates a, and so is its force
spread over them. Among all forces on the three nodes that move the contact point by exactly u
these are the smallest in the sense of elastic energy::

    C = sum_ab a_a a_b L_ab        F_a = a_a C^-1 u

C is symmetric and positive definite. At a node this is (9); on an edge the third node has no part,
so that the force is continuous over edges.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


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
