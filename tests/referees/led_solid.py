"""A solid some of whose freedoms are led: the others come to rest by Newton's method."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array
from scipy.sparse.linalg import splu

from palpate.core.shape.solid.inversion import unhindered_share
from palpate.core.shape.solid.solid import Solid

CONVERGED = 1e-8
MOST_STEPS = 60
SHORTEST_PART = 1e-6
# Where the tangent is not positive definite its convex part is taken, which may be singular.
RIDGE = 1e-9


def settled(body: Solid, u: NDArray[np.float64], free: NDArray[np.int64]) -> NDArray[np.float64]:
    """Displacements (N, 3) at rest: ``free`` freedoms (f,) without force, the others as in ``u``.

    Raises
    ------
    ArithmeticError
        Newton's method does not come to an end.
    """
    for _ in range(MOST_STEPS):
        forces = body.forces(u)
        rest = -forces.ravel()[free]
        if np.abs(rest).max() < CONVERGED * np.abs(forces).max():
            return u
        way = np.zeros(u.shape)
        way.flat[free] = _downhill(body, u, free, rest)
        part, energy = unhindered_share(body, u, way), body.energy(u)
        while body.energy(u + part * way) > energy + 1e-12 * abs(energy):
            part *= 0.5
            if part < SHORTEST_PART:
                raise ArithmeticError("no way down")
        u = u + part * way
    raise ArithmeticError("no equilibrium")


def _downhill(
    body: Solid, u: NDArray[np.float64], free: NDArray[np.int64], rest: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Newton's step; by the convex part of the tangent where a pivot of the whole is negative."""
    pattern, size = body.pattern, u.size
    starts = np.searchsorted(pattern.rows, np.arange(len(u) + 1))
    for convex in (False, True):
        blocks = body.tangent_blocks(u, convex=convex)
        matrix = bsr_array((blocks, pattern.columns, starts), shape=(size, size)).tocsr()
        own = matrix[free][:, free].tocsc()
        own.setdiag(own.diagonal() * (1.0 + RIDGE * convex))
        factor = splu(
            own,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        if convex or (factor.U.diagonal() > 0.0).all():
            break
    step: NDArray[np.float64] = factor.solve(rest)
    return step
