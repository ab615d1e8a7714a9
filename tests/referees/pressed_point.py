"""A contact point moved by a given displacement in the solid of large deformation, by Newton."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from palpate.core.compliance.elimination.cholesky import NotPositiveDefiniteError
from palpate.core.shape.solid.free_solid import FreeSolid

MOST_ITERATIONS = 12
CONVERGED = 1e-9
# In displacements of the contact point: further than this, Newton has lost its way.
MOST_STEP = 10.0
# Beyond the largest force that a solid bears, only small ones are followed: by a general solver.
MOST_NODES_BEYOND = 1000


@dataclass(frozen=True, eq=False)
class PressedPoint:
    """How a body bears on its way.

    Attributes
    ----------
    forces : (k, 3), that hold the contact point, at unit modulus; fewer rows than were asked for
        where an element would turn inside out or Newton's method ends.
    volume_ratios : (k,), the least of all elements.
    """

    forces: NDArray[np.float64]
    volume_ratios: NDArray[np.float64]


def pressed_point(
    solid: FreeSolid,
    nodes: NDArray[np.int64],
    alpha: NDArray[np.float64],
    displacements: NDArray[np.float64],
) -> PressedPoint:
    """Forces that move the mean of ``nodes`` weighted by ``alpha`` by displacements (k, 3) in turn.

    The forces are the multipliers of this constraint, so that places of small bodies are followed
    also beyond the largest force that the solid bears.
    """
    size = 3 * solid.node_count
    seen = np.zeros((size, 3))
    for place, weight in zip(np.searchsorted(solid.free, nodes), alpha, strict=True):
        if weight:
            seen[3 * place : 3 * place + 3] += weight * np.eye(3)
    u, force = np.zeros(size), np.zeros(3)
    ahead = solid.factor.solve(seen)
    forces, ratios = [], []
    for wanted in displacements:
        u = u + ahead @ np.linalg.solve(seen.T @ ahead, wanted - seen.T @ u)
        for _ in range(MOST_ITERATIONS):
            shape = u.reshape(-1, 3)
            solve = _tangent_solver(solid, shape)
            if solve is None:
                return PressedPoint(np.array(forces).reshape(-1, 3), np.array(ratios))
            ahead = solve(seen)
            rest = solve((seen @ force - solid.forces(shape).ravel())[:, None])[:, 0]
            more = np.linalg.solve(seen.T @ ahead, wanted - seen.T @ (u + rest))
            step = rest + ahead @ more
            u, force = u + step, force + more
            if np.abs(step).max() > MOST_STEP * np.linalg.norm(wanted):
                return PressedPoint(np.array(forces).reshape(-1, 3), np.array(ratios))
            if np.abs(step).max() < CONVERGED * np.abs(u).max():
                break
        else:
            break
        ratio = float(solid.volume_ratios(u.reshape(-1, 3)).min())
        if ratio <= 0:
            break
        forces.append(force)
        ratios.append(ratio)
    return PressedPoint(np.array(forces).reshape(-1, 3), np.array(ratios))


def _tangent_solver(
    solid: FreeSolid, shape: NDArray[np.float64]
) -> Callable[[NDArray[np.float64]], NDArray[np.float64]] | None:
    try:
        return solid.elimination.factor(solid.solid.tangent_blocks(shape)).solve
    except NotPositiveDefiniteError:
        if solid.node_count > MOST_NODES_BEYOND:
            return None
        # Beyond the largest force: held at the contact point alone, the body is still stable.
        return splu(solid.tangent(shape).tocsc(), permc_spec="MMD_AT_PLUS_A").solve
