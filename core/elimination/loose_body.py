"""How an elimination finds out that a body is not held."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError

# A pivot that the elimination has brought down to this share of the diagonal it began with is all
# rounding error: the freedom has no stiffness left once the others are free to give way.
SMALLEST_PIVOT_SHARE = 1e-13


def refuse_loose(
    breakdown: int, pivots: NDArray[np.float64], stiffness: NDArray[np.float64]
) -> None:
    """Refuse a body that can move without strain.

    Parameters
    ----------
    breakdown : what LAPACK's potrf says; above 0 if a pivot was not positive.
    pivots : (p,), what is left of the diagonal when its turn comes.
    stiffness : (p,), the diagonal as assembled.

    Raises
    ------
    PalpateError
        A pivot that is not positive, or too small beside its stiffness to be more than rounding.
    """
    if breakdown or not (pivots > SMALLEST_PIVOT_SHARE * stiffness).all():
        raise PalpateError(
            "stiffness: the body is not held by its pins (parts that meet only in a node or an "
            "edge can swing); pin each part, or bake with a finer edge length so that they join"
        )
