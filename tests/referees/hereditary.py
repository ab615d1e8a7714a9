"""The force of a body that gives way with time, slowly and in numpy, from what an elastic one does.

While contact grows, the force of a linear body at a constant Poisson's ratio is ::

    F(t) = integral of E(t - s) / E dF_e(s)

with F_e the force at the modulus in the end under the same way (E. H. Lee and J. R. M. Radok: The
contact problem for viscoelastic bodies, Journal of Applied Mechanics 27, 1960, 438-444).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def held_force(
    series: Sequence[tuple[float, float]], elastic: NDArray[np.float64], dt: float
) -> NDArray[np.float64]:
    """F (n,) of an elastic force F_e (n,) that goes evenly from tick to tick, every ``dt`` s.

    ``series`` are pairs of a share of the modulus in the end and of seconds.
    """
    steps = np.diff(elastic, prepend=0.0)
    found = elastic.copy()
    for share, seconds in series:
        x, left = dt / seconds, 0.0
        for tick, step in enumerate(steps):
            left = left * np.exp(-x) + share * step * -np.expm1(-x) / x
            found[tick] += left
    return found
