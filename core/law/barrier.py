"""What keeps a place from vanishing: x - 1 - ln x, which grows without end as x falls to zero.

Below :data:`FLATTEST` it goes on as the parabola that touches it there to second order. So it is
defined, convex and smooth for every x: a step of a solver may pass through what is inside out and
come back, and energies stay finite.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

# Of volume or length, about what nothing that is pressed comes to.
FLATTEST = 0.05
# Up to this |x - 1| / (x + 1) the series of the logarithm is summed, to the last digit.
NEAR = 0.03


class Derivatives(NamedTuple):
    """A function's value, slope and curvature, (d,) each."""

    value: NDArray[np.float64]
    slope: NDArray[np.float64]
    curvature: NDArray[np.float64]


def barrier(excess: NDArray[np.float64]) -> Derivatives:
    """The barrier at x = 1 + ``excess`` (d,), exact to rounding also where ``excess`` is small."""
    x = np.maximum(1.0 + excess, FLATTEST)
    over = np.maximum(excess, FLATTEST - 1.0)
    below = np.minimum(excess - over, 0.0)
    slope, curvature = over / x, 1.0 / (x * x)
    value = _less_logarithm(over)
    return Derivatives(
        value + below * (slope + 0.5 * below * curvature), slope + below * curvature, curvature
    )


def _less_logarithm(excess: NDArray[np.float64]) -> NDArray[np.float64]:
    """Excess less ln(1 + excess)."""
    # ln x = 2 (z + z^3/3 + z^5/5 + ...), z = excess / (2 + excess); excess - 2 z = excess z.
    z = excess / (2.0 + excess)
    near = np.where(np.abs(z) <= NEAR, z, 0.0)
    square = near * near
    tail = square * (1 / 3 + square * (1 / 5 + square * (1 / 7 + square * (1 / 9))))
    series = excess * near - 2.0 * near * tail
    found: NDArray[np.float64] = np.where(
        np.abs(z) <= NEAR, series, excess - np.log1p(np.maximum(excess, FLATTEST - 1.0))
    )
    return found
