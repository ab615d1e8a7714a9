"""The complementarity problem of a contact that may only push.

Find forces f >= 0 with gaps w = A f + g >= 0 and f_i w_i = 0 for a symmetric positive definite A:
the least of the energy 1/2 f A f + g f over f >= 0. Sweeps of projected Gauss-Seidel find which
points carry force, a Cholesky solve on these makes it exact, in turns, after J. J. More and G.
Toraldo, *On the solution of large quadratic programming problems with bound constraints* (SIAM J.
Optim. 1, 1991). The energy falls in every step. So no set of points comes back, there is no
cycling, and where the bound on the work ends it early the forces are still a valid push, nearer the
solution than at the start. The servo does the same natively, step by step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cho_factor, cho_solve

# Rounds of sweep and exact solve. From the tick before one or two are enough, from nothing about
# five.
MOST_ROUNDS = 40

# Halvings of a step that would raise the energy, before the last one that cannot.
MOST_HALVINGS = 4

# Of what rounding leaves in the sum A f + g, this many units count as zero.
ROUNDING_UNITS = 64.0


@dataclass(frozen=True, eq=False)
class Pushes:
    """Solution of a complementarity problem.

    Attributes
    ----------
    forces : float64 (p,), all >= 0.
    gaps : float64 (p,), A f + g.
    rounds : how many rounds it took.
    exact : whether the conditions hold to rounding; else the bound on the work ended it.
    """

    forces: NDArray[np.float64]
    gaps: NDArray[np.float64]
    rounds: int
    exact: bool


def solve_complementarity(
    matrix: NDArray[np.float64],
    gaps: NDArray[np.float64],
    start: NDArray[np.float64] | None = None,
    most_rounds: int = MOST_ROUNDS,
) -> Pushes:
    """Forces f >= 0 with ``matrix`` f + ``gaps`` >= 0, one of both zero for each point.

    Parameters
    ----------
    matrix : (p, p), symmetric positive definite.
    gaps : (p,), negative where the points overlap the tool while no force acts.
    start : (p,) forces to begin with, such as the last tick's; what is negative counts as zero.
    most_rounds : bound on the work; at least one sweep is always made.
    """
    forces = np.zeros(len(gaps)) if start is None else np.maximum(start, 0.0)
    # A start of more energy than nothing at all would be worse than none.
    if _energy(matrix, gaps, forces) > 0.0:
        forces = np.zeros(len(gaps))
    opened = matrix @ forces + gaps
    for made in range(1, most_rounds + 1):
        forces = sweep(matrix, gaps, forces)
        forces = _least_on_face(matrix, gaps, forces)
        opened = matrix @ forces + gaps
        if solved(matrix, gaps, forces, opened):
            return Pushes(forces, opened, made, exact=True)
    return Pushes(forces, opened, most_rounds, exact=False)


def sweep(
    matrix: NDArray[np.float64], gaps: NDArray[np.float64], forces: NDArray[np.float64]
) -> NDArray[np.float64]:
    """One sweep of projected Gauss-Seidel: each force in turn as its own gap demands, (p,)."""
    swept = forces.copy()
    for i in range(len(gaps)):
        gap = matrix[i] @ swept + gaps[i]
        swept[i] = max(0.0, swept[i] - gap / matrix[i, i])
    return swept


def solved(
    matrix: NDArray[np.float64],
    gaps: NDArray[np.float64],
    forces: NDArray[np.float64],
    opened: NDArray[np.float64],
) -> bool:
    """Whether ``opened`` = A f + g is zero under force and nowhere negative, up to rounding."""
    unit = ROUNDING_UNITS * np.finfo(float).eps * (np.abs(matrix) @ forces + np.abs(gaps))
    pressed = forces > 0.0
    return bool((opened >= -unit).all() and (opened[pressed] <= unit[pressed]).all())


def _least_on_face(
    matrix: NDArray[np.float64], gaps: NDArray[np.float64], forces: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Least energy among forces on the points that carry any now, dropping what would pull."""
    forces = forces.copy()
    while (carrying := np.flatnonzero(forces > 0.0)).size:
        own = matrix[np.ix_(carrying, carrying)]
        try:
            exact = cho_solve(cho_factor(own, lower=True), -gaps[carrying])
        except LinAlgError:
            # Not positive definite to rounding: the sweeps alone, which need only the diagonal.
            return forces
        if (exact > 0.0).all():
            forces[carrying] = exact
            return forces
        forces[carrying] = _towards(own, gaps[carrying], forces[carrying], exact)
    return forces


def _towards(
    matrix: NDArray[np.float64],
    gaps: NDArray[np.float64],
    forces: NDArray[np.float64],
    exact: NDArray[np.float64],
) -> NDArray[np.float64]:
    """From ``forces`` > 0 towards ``exact``, clipped at zero; at least one force becomes zero."""
    energy = _energy(matrix, gaps, forces)
    share = 1.0
    for _ in range(MOST_HALVINGS):
        tried = np.maximum(forces + share * (exact - forces), 0.0)
        if (tried == 0.0).any() and _energy(matrix, gaps, tried) < energy:
            return tried
        share *= 0.5
    # As far as the first force that becomes zero: nothing is clipped, so the energy falls.
    pulling = exact <= 0.0
    ratios = np.full(len(forces), np.inf)
    ratios[pulling] = forces[pulling] / (forces[pulling] - exact[pulling])
    first = int(ratios.argmin())
    nearer: NDArray[np.float64] = np.maximum(forces + ratios[first] * (exact - forces), 0.0)
    nearer[first] = 0.0
    return nearer


def _energy(
    matrix: NDArray[np.float64], gaps: NDArray[np.float64], forces: NDArray[np.float64]
) -> float:
    return float(0.5 * forces @ matrix @ forces + gaps @ forces)
