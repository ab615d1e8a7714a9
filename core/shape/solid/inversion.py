"""Largest step along a direction before an element is inverted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .solid import Solid

# What an element keeps of its volume at least. Flatter ones would invert by rounding.
LEAST_VOLUME_RATIO = 1e-3

# Of the way to an inversion, the share that is gone at most: a limit is approached, not reached.
SHARE_OF_WAY = 0.9


def is_upright(body: Solid, displacements: NDArray[np.float64]) -> bool:
    """Whether every element keeps at least a thousandth of its volume, and its orientation."""
    return all(
        bool((term.volume_ratios(displacements) >= LEAST_VOLUME_RATIO).all()) for term in body.terms
    )


def unhindered_share(
    body: Solid, displacements: NDArray[np.float64], way: NDArray[np.float64]
) -> float:
    """Largest share of ``way``, at most 1, on which every element's det F stays above zero.

    Where an element would invert on the way, nine tenths of the way to there. det(F + t G) first
    vanishes at the smallest positive t = -1 / m, m a real eigenvalue of F^-1 G; elements in which
    G is too small for that are not looked at further.

    Parameters
    ----------
    displacements : (N, 3), without inverted elements.
    way : (N, 3), what would be added to them.
    """
    first = np.inf
    for term in body.terms:
        moved = np.eye(3) + term.displacement_gradients(displacements)
        relative = np.linalg.solve(moved, term.displacement_gradients(way))
        # Eigenvalues are not larger than the norm, so that below 1 no root lies within the way.
        endangered = relative[np.einsum("dij,dij->d", relative, relative) >= SHARE_OF_WAY**2]
        if not len(endangered):
            continue
        values = np.linalg.eigvals(endangered)
        shrinking = values.real[(np.abs(values.imag) <= 1e-9 * np.abs(values)) & (values.real < 0)]
        if shrinking.size:
            first = min(first, float(-1.0 / shrinking.min()))
    return min(1.0, SHARE_OF_WAY * first)
