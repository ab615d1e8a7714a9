"""Change of volume by H: invariants, and what they add to a tangent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .by_component import Array, cofactors, determinants, diagonal

# The sign of each even or odd order of three axes, zero where one comes twice.
PERMUTATIONS = np.zeros((3, 3, 3))
PERMUTATIONS[[0, 1, 2], [1, 2, 0], [2, 0, 1]] = 1.0
PERMUTATIONS[[0, 2, 1], [2, 1, 0], [1, 0, 2]] = -1.0
# Which component of F the derivative of cof F has at each place, and with which sign.
TWICE = np.einsum("ikm,JLN->iJkLmN", PERMUTATIONS, PERMUTATIONS).reshape(81, 9)


def second_invariant(gradient: Array) -> NDArray[np.float64]:
    """Sum of the principal minors of H (3, 3, d): what det(I + H) - 1 has between trace and det."""
    h = gradient
    found: NDArray[np.float64] = h[0, 0] * h[1, 1] - h[0, 1] * h[1, 0]
    found += h[1, 1] * h[2, 2] - h[1, 2] * h[2, 1]
    found += h[2, 2] * h[0, 0] - h[2, 0] * h[0, 2]
    return found


def volume_change(gradient: Array) -> NDArray[np.float64]:
    """J - 1 (d,), exact to rounding also where H is small."""
    trace = diagonal(gradient).sum(axis=0)
    found: NDArray[np.float64] = trace + second_invariant(gradient) + determinants(gradient)
    return found


def change_of_cofactors(matrices: Array) -> NDArray[np.float64]:
    """Derivative of cof A by A, (d, 9, 9)."""
    found: NDArray[np.float64] = (TWICE @ matrices.reshape(9, -1)).T.reshape(-1, 9, 9)
    return found


def volume_tangent(moved: Array, slope: NDArray[np.float64]) -> NDArray[np.float64]:
    """Part (d, 9, 9) of a tangent by which the pressure's derivative by J, ``slope``, enters."""
    rows = cofactors(moved).reshape(9, -1).T
    found: NDArray[np.float64] = (slope[:, None] * rows)[:, :, None] * rows[:, None, :]
    return found
