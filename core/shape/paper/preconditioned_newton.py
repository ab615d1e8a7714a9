"""Newton's method for many loads at once with the factor of the stiffness at rest.

The tangent is never assembled: each step is solved by conjugate gradients, preconditioned with K.
Near equilibrium, as at the end of a power series, a step takes a few iterations, and an iteration
costs one evaluation of the forces and one solve.

References
----------
J. Nocedal, S. J. Wright: Numerical Optimization, Springer, 2nd edition, 2006; algorithm 7.1 (line
search Newton-CG) and section 5.1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .power_series import SeriesSolid

MOST_STEPS = 6
MOST_ITERATIONS = 30
# How far a step is solved, and when the last was small enough, both relative.
STEP_ERROR = 3e-2
SETTLED = 1e-4
# A step is halved so often at most to keep every domain from turning inside out.
MOST_HALVINGS = 4


@dataclass(frozen=True, eq=False)
class Polished:
    """Equilibria of several loads.

    Attributes
    ----------
    displacements : (f, 3, k).
    is_settled : bool (k,); where it is not, there is no equilibrium nearby, or it is unstable.
    """

    displacements: NDArray[np.float64]
    is_settled: NDArray[np.bool_]


def polished(
    body: SeriesSolid, forces: NDArray[np.float64], start: NDArray[np.float64]
) -> Polished:
    """Equilibria under forces (f, 3, k), from displacements nearby, both at unit modulus."""
    displacements = start.copy()
    is_settled = np.zeros(forces.shape[2], dtype=bool)
    at_work = np.flatnonzero(body.smallest_volume_ratio(start) > 0)
    for _ in range(MOST_STEPS):
        if not len(at_work):
            break
        here = displacements[:, :, at_work]
        step, is_stable = _step(body, here, forces[:, :, at_work] - body.forces(here))
        step *= _uninverted_share(body, here, step)
        displacements[:, :, at_work] += step
        size = _norms(step) / _norms(displacements[:, :, at_work])
        is_settled[at_work] = is_stable & (size < SETTLED)
        at_work = at_work[is_stable & ~is_settled[at_work]]
    return Polished(displacements, is_settled)


def _step(
    body: SeriesSolid, displacements: NDArray[np.float64], missing: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Newton's step for forces that are missing, and whether the tangent was found positive."""
    step = np.zeros_like(missing)
    is_stable = np.ones(missing.shape[2], dtype=bool)
    rest = missing.copy()
    lifted = body.solve(rest)
    direction = lifted.copy()
    size = first = _dots(rest, lifted)
    for _ in range(MOST_ITERATIONS):
        on = is_stable & (size > STEP_ERROR**2 * first)
        if not on.any():
            break
        felt = body.tangent_forces(displacements, direction)
        curvature = _dots(direction, felt)
        is_stable &= ~on | (curvature > 0)
        on &= is_stable
        length = np.divide(size, curvature, out=np.zeros_like(size), where=on)
        step += length * direction
        rest -= length * felt
        lifted = body.solve(rest)
        newer = _dots(rest, lifted)
        direction = lifted + np.divide(newer, size, out=np.zeros_like(size), where=on) * direction
        size = np.where(on, newer, size)
    return step, is_stable


def _uninverted_share(
    body: SeriesSolid, displacements: NDArray[np.float64], step: NDArray[np.float64]
) -> NDArray[np.float64]:
    share = np.ones(step.shape[2])
    for _ in range(MOST_HALVINGS):
        inverted = body.smallest_volume_ratio(displacements + share * step) <= 0
        if not inverted.any():
            break
        share[inverted] /= 2
    return share


def _dots(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    dots: NDArray[np.float64] = np.einsum("nik,nik->k", one, other)
    return dots


def _norms(field: NDArray[np.float64]) -> NDArray[np.float64]:
    norms: NDArray[np.float64] = np.sqrt(_dots(field, field))
    return norms
